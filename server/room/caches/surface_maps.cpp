#include "room/caches/surface_maps.h"

#include <boost/asio/post.hpp>

#include "mesh/texels/tile_bounds.h"
#include "room/caches/await.h"

namespace strata::room {

SurfaceMaps::MapPtr SurfaceMaps::get(int resolution) const {
  std::lock_guard lock(mutex_);
  auto found = entries_.find(resolution);
  if (found == entries_.end() || !found->second.on_gpu) return nullptr;
  found->second.last_use = Clock::now();
  return found->second.baked;
}

void SurfaceMaps::request(int resolution, Ready ready) {
  MapPtr map;
  {
    std::lock_guard lock(mutex_);
    Entry& entry = entries_[resolution];
    if (!entry.on_gpu) {
      entry.waiting.push_back(std::move(ready));
      if (!entry.working) start(resolution);
      return;
    }
    entry.last_use = Clock::now();
    map = entry.baked;
  }
  ready(map);
}

Result<SurfaceMaps::MapPtr> SurfaceMaps::wait(int resolution) {
  return await_for_question<MapPtr>([&](auto ready) { request(resolution, std::move(ready)); });
}

void SurfaceMaps::make_bounds(int resolution) {
  {
    std::lock_guard lock(mutex_);
    if (bounds_.contains(resolution)) return;
  }
  auto made = std::make_shared<const std::vector<mesh::BoundingSphere>>(
      mesh::bound_tiles(*geometry_, resolution));
  std::lock_guard lock(mutex_);
  bounds_[resolution] = std::move(made);
}

SurfaceMaps::Bounds SurfaceMaps::bounds(int resolution) const {
  std::lock_guard lock(mutex_);
  if (const auto found = bounds_.find(resolution); found != bounds_.end()) return found->second;
  const auto entry = entries_.find(resolution);
  if (entry == entries_.end() || !entry->second.baked) return nullptr;
  return {entry->second.baked, &entry->second.baked->bounds_of_tile};
}

void SurfaceMaps::set_model(render::ModelHandle model) {
  std::lock_guard lock(mutex_);
  model_ = model;
  for (auto& [resolution, entry] : entries_) {
    entry.on_gpu = false;
    if (entry.baked && !entry.working) start(resolution);
  }
}

SurfaceMaps::Entries::const_iterator SurfaceMaps::oldest() const {
  auto oldest = entries_.end();
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    if (!entry->second.baked || entry->second.working) continue;
    if (oldest == entries_.end() || entry->second.last_use < oldest->second.last_use)
      oldest = entry;
  }
  return oldest;
}

std::optional<SurfaceMaps::Clock::time_point> SurfaceMaps::oldest_use() const {
  std::lock_guard lock(mutex_);
  const auto entry = oldest();
  return entry == entries_.end() ? std::nullopt : std::optional(entry->second.last_use);
}

bool SurfaceMaps::drop_oldest() {
  std::lock_guard lock(mutex_);
  const auto entry = oldest();
  if (entry == entries_.end()) return false;
  renderer_.remove_surface_map(model_, entry->first);
  entries_.erase(entry);
  return true;
}

bool SurfaceMaps::drop_unused(Clock::time_point since, std::uint64_t at_least_bytes) {
  std::lock_guard lock(mutex_);
  return std::erase_if(entries_, [&](const auto& each) {
           const auto& [resolution, entry] = each;
           if (!entry.baked || entry.working || entry.last_use >= since ||
               entry.share.bytes() < at_least_bytes)
             return false;
           renderer_.remove_surface_map(model_, resolution);
           return true;
         }) > 0;
}

void SurfaceMaps::start(int resolution) {
  Entry& entry = entries_[resolution];
  entry.working = true;
  boost::asio::post(workers_, [self = shared_from_this(), resolution] {
    MapPtr map;
    render::ModelHandle model = 0;
    {
      std::lock_guard lock(self->mutex_);
      map = self->entries_[resolution].baked;
      model = self->model_;
    }
    if (!map) {
      auto baked = mesh::bake_surface_map(*self->geometry_, resolution, self->progress_);
      if (!baked) return self->finish(resolution, tl::unexpected(baked.error()), model);
      auto share = self->memory_.reserve(
          baked->bytes(), "a surface map with resolution " + std::to_string(resolution));
      if (!share) return self->finish(resolution, tl::unexpected(share.error()), model);
      map = std::make_shared<const mesh::SurfaceMap>(std::move(*baked));
      std::lock_guard lock(self->mutex_);
      self->entries_[resolution].baked = map;
      self->entries_[resolution].share = std::move(*share);
    }
    self->upload(resolution, map, model);
  });
}

void SurfaceMaps::upload(int resolution, const MapPtr& map, render::ModelHandle model) {
  renderer_.add_surface_map(
      model, map, [self = shared_from_this(), resolution, map, model](Result<void> done) {
        self->finish(resolution, done ? Result<MapPtr>(map) : tl::unexpected(done.error()), model);
      });
}

void SurfaceMaps::finish(int resolution, const Result<MapPtr>& result, render::ModelHandle model) {
  std::vector<Ready> waiting;
  {
    std::unique_lock lock(mutex_);
    Entry& entry = entries_[resolution];
    // The handle of the model may have changed during the upload (lost context). In this case, the
    // upload is repeated with the new handle.
    if (entry.baked && model_ != model) {
      model = model_;
      const MapPtr again = entry.baked;
      lock.unlock();
      return upload(resolution, again, model);
    }
    entry.working = false;
    entry.on_gpu = result.has_value();
    entry.last_use = Clock::now();
    waiting.swap(entry.waiting);
  }
  for (auto& ready : waiting) ready(result);
}

}  // namespace strata::room
