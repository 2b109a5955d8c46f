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

// The surface maps of one model. A background thread bakes a map on first use, in about a second,
// and uploads it to the GPU. Thread-safe.
class SurfaceMaps : public std::enable_shared_from_this<SurfaceMaps> {
 public:
  using MapPtr = std::shared_ptr<const mesh::SurfaceMap>;
  using Ready = std::function<void(Result<MapPtr>)>;

  SurfaceMaps(std::shared_ptr<const mesh::Geometry> geometry, render::Renderer& renderer,
              MemoryLedger& memory, boost::asio::thread_pool& workers)
      : geometry_(std::move(geometry)), renderer_(renderer), memory_(memory), workers_(workers) {}

  // Returns the map if it is baked and on the GPU. Otherwise returns null, and starts no work.
  MapPtr get(int resolution) const;
  // Calls `ready` when the map is ready, on any thread. Calls it immediately if the map is already
  // ready.
  void request(int resolution, Ready ready);
  // Blocks. For worker threads.
  Result<MapPtr> wait(int resolution);

  // The bounds of the surface in each tile, of the map, or without one (mesh/texels/tile_bounds.h).
  // A room where nobody paints needs no map, so it calls `make_bounds`. They take up to 256 KiB for
  // each resolution, and stay. `bounds` returns null if there is neither.
  using Bounds = std::shared_ptr<const std::vector<mesh::BoundingSphere>>;
  void make_bounds(int resolution);
  Bounds bounds(int resolution) const;

  // Sets the handle of the model, which is new after a lost context. Baked maps are uploaded again.
  void set_model(render::ModelHandle model);
  // Maps can be dropped to free memory, and are baked again on use.
  using Clock = std::chrono::steady_clock;
  // Returns the time at which the least recently used map was last used.
  std::optional<Clock::time_point> oldest_use() const;
  // Drops the least recently used map. Returns false if there is no map. Call only while nothing is
  // being painted, because painting needs the map on the GPU.
  bool drop_oldest();
  // Drops maps of at least `at_least_bytes` that were unused since `since`. Returns false if there
  // is no such map. Like `drop_oldest`, call it only while nothing is being painted.
  bool drop_unused(Clock::time_point since, std::uint64_t at_least_bytes);
  void stop() { progress_.cancel(); }

 private:
  struct Entry {
    MapPtr baked;
    MemoryLedger::Share share;  // for `baked`
    mutable Clock::time_point last_use{};
    bool on_gpu = false;
    bool working = false;
    std::vector<Ready> waiting;
  };
  using Entries = std::map<int, Entry>;
  Entries::const_iterator oldest() const;  // call while holding the mutex
  void start(int resolution);              // call while holding the mutex
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
  std::map<int, Bounds> bounds_;  // by resolution
};

}  // namespace strata::room
