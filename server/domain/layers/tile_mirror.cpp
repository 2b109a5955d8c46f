#include "domain/layers/tile_mirror.h"

namespace strata {

TileMirror::Snapshot TileMirror::snapshot() const {
  std::lock_guard lock(mutex_);
  return {tiles_, sequence_};
}

std::shared_ptr<const TileData> TileMirror::tile(TileAddress address) const {
  std::lock_guard lock(mutex_);
  auto found = tiles_.find(address);
  return found == tiles_.end() ? nullptr : found->second;
}

std::int64_t TileMirror::sequence() const {
  std::lock_guard lock(mutex_);
  return sequence_;
}

std::size_t TileMirror::bytes() const {
  std::lock_guard lock(mutex_);
  return tiles_.size() * (sizeof(TileData) + std::size_t{kTexelsPerTile} * bytes_per_texel(type_));
}

bool TileMirror::empty() const {
  std::lock_guard lock(mutex_);
  return tiles_.empty();
}

void TileMirror::assign(TileMap tiles, std::int64_t sequence) {
  std::erase_if(tiles,
                [](const auto& entry) { return !entry.second || !entry.second->valid.any(); });
  std::lock_guard lock(mutex_);
  tiles_ = std::move(tiles);
  sequence_ = sequence;
}

std::shared_ptr<const void> TileMirror::hold() const {
  ++*holds_;
  return {holds_.get(), [holds = holds_](const void*) { --*holds; }};
}

void TileMirror::put(const TileMap& tiles, std::int64_t sequence) {
  std::lock_guard lock(mutex_);
  for (const auto& [address, data] : tiles) {
    if (data && data->valid.any())
      tiles_[address] = data;
    else
      tiles_.erase(address);
  }
  sequence_ = sequence;
}

}  // namespace strata
