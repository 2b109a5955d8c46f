#pragma once

#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "core/progress.h"
#include "mesh/surface_map.h"
#include "render/renderer.h"

namespace strata::room {

// The surface maps of one model, baked when first asked for (a second or so) on a background thread and put on the GPU.
// Thread-safe.
class SurfaceMaps : public std::enable_shared_from_this<SurfaceMaps> {
 public:
  using MapPtr = std::shared_ptr<const mesh::SurfaceMap>;
  using Ready = std::function<void(Result<MapPtr>)>;

  SurfaceMaps(std::shared_ptr<const mesh::Geometry> geometry, render::Renderer& renderer,
              boost::asio::thread_pool& workers)
      : geometry_(std::move(geometry)), renderer_(renderer), workers_(workers) {}

  // The map if it is baked and on the GPU, otherwise null (and nothing is started).
  MapPtr get(int resolution) const;
  // Calls `ready` when it is, on any thread; at once when it is already.
  void request(int resolution, Ready ready);
  // Blocks; for worker threads.
  Result<MapPtr> wait(int resolution);

  // The model's handle, new after a lost context: baked maps are put on the GPU again.
  void set_model(render::ModelHandle model);
  void stop() { progress_.cancel(); }

 private:
  struct Entry {
    MapPtr baked;
    bool on_gpu = false;
    bool working = false;
    std::vector<Ready> waiting;
  };
  void start(int resolution);  // with the lock held
  void upload(int resolution, MapPtr map, render::ModelHandle model);
  void finish(int resolution, Result<MapPtr> result, render::ModelHandle model);

  const std::shared_ptr<const mesh::Geometry> geometry_;
  render::Renderer& renderer_;
  boost::asio::thread_pool& workers_;
  Progress progress_;
  mutable std::mutex mutex_;
  render::ModelHandle model_ = 0;
  std::map<int, Entry> entries_;
};

}  // namespace strata::room
