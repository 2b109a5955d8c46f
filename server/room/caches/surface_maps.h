#pragma once

#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/memory_ledger.h"
#include "core/progress.h"
#include "mesh/texels/surface_map.h"
#include "render/renderer.h"

namespace strata::room {

// The surface maps of one model, baked on first use (a second or so) on a background thread and
// uploaded to the GPU. Thread-safe.
class SurfaceMaps : public std::enable_shared_from_this<SurfaceMaps> {
 public:
  using MapPtr = std::shared_ptr<const mesh::SurfaceMap>;
  using Ready = std::function<void(Result<MapPtr>)>;

  SurfaceMaps(std::shared_ptr<const mesh::Geometry> geometry, render::Renderer& renderer,
              MemoryLedger& memory, boost::asio::thread_pool& workers)
      : geometry_(std::move(geometry)), renderer_(renderer), memory_(memory), workers_(workers) {}

  // Returns the map if it is baked and on the GPU, otherwise null (and starts nothing).
  MapPtr get(int resolution) const;
  // Calls `ready` when the map is ready, on any thread; at once if it is ready already.
  void request(int resolution, Ready ready);
  // Blocks; for worker threads.
  Result<MapPtr> wait(int resolution);

  // Sets the model's handle, which is new after a lost context: baked maps are uploaded again.
  void set_model(render::ModelHandle model);
  // Maps can be dropped to free memory; they are baked again on use.
  using Clock = std::chrono::steady_clock;
  // of the map that was unused for the longest time
  std::optional<Clock::time_point> oldest_use() const;
  // Drops that map; false if there is no map. Call only while nothing is being painted, because
  // painting needs the map on the GPU.
  bool drop_oldest();
  // Drops the maps of at least `at_least_bytes` that were unused since `since`; false if there is
  // no such map. The same restriction applies.
  bool drop_unused(Clock::time_point since, std::uint64_t at_least_bytes);
  void stop() { progress_.cancel(); }

 private:
  struct Entry {
    MapPtr baked;
    MemoryLedger::Share share;  // of `baked`
    mutable Clock::time_point last_use{};
    bool on_gpu = false;
    bool working = false;
    std::vector<Ready> waiting;
  };
  using Entries = std::map<int, Entry>;
  Entries::const_iterator oldest() const;  // with the lock held
  void start(int resolution);              // with the lock held
  void upload(int resolution, const MapPtr& map, render::ModelHandle model);
  void finish(int resolution, const Result<MapPtr>& result, render::ModelHandle model);

  const std::shared_ptr<const mesh::Geometry> geometry_;
  render::Renderer& renderer_;
  MemoryLedger& memory_;
  boost::asio::thread_pool& workers_;
  Progress progress_;
  mutable std::mutex mutex_;
  render::ModelHandle model_ = 0;
  Entries entries_;
};

}  // namespace strata::room
