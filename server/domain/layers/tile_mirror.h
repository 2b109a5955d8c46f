#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "domain/layers/tile.h"

namespace strata {

using TileMap = std::unordered_map<TileAddress, std::shared_ptr<const TileData>>;

// The content of one layer in main memory: the tiles that have a valid texel, and the sequence of
// the last edit that they contain. Stored tiles are immutable, so a snapshot is a consistent state
// and does not copy texels. Thread-safe.
class TileMirror {
 public:
  TileMirror(ValueType type, int resolution) : type_(type), resolution_(resolution) {}

  ValueType type() const { return type_; }
  int resolution() const { return resolution_; }

  struct Snapshot {
    TileMap tiles;
    std::int64_t sequence = 0;
  };
  Snapshot snapshot() const;
  // Returns null if the tile has no valid texel.
  std::shared_ptr<const TileData> tile(TileAddress address) const;
  std::int64_t sequence() const;
  std::size_t bytes() const;
  bool empty() const;  // returns whether no texel is valid

  // Replaces tiles in one step; null or empty tiles are removed. Call in the order of sequences.
  void put(const TileMap& tiles, std::int64_t sequence);
  // Replaces all tiles.
  void assign(TileMap tiles, std::int64_t sequence);

  // Returns a handle. Acquire it before an edit is passed to the GPU. Release it after `put` has
  // stored the edit, or after the edit was refused. In between, the tiles on the GPU may be newer
  // than those of the mirror. The handle may outlive the mirror.
  std::shared_ptr<const void> hold() const;
  bool held() const { return *holds_ > 0; }

 private:
  const ValueType type_;
  const int resolution_;
  const std::shared_ptr<std::atomic<int>> holds_ = std::make_shared<std::atomic<int>>(0);
  mutable std::mutex mutex_;
  TileMap tiles_;
  std::int64_t sequence_ = 0;
};

}  // namespace strata
