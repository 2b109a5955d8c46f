#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "domain/layers/tile.h"

namespace strata {

using TileMap = std::unordered_map<TileAddress, std::shared_ptr<const TileData>>;

// What one layer holds, on the CPU: the tiles that have a valid texel, and the sequence of the last
// edit in them. Tiles are immutable once put in, so a snapshot is a consistent state that costs no
// texel copy. Thread-safe.
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
  // null when nothing in it is valid
  std::shared_ptr<const TileData> tile(TileAddress address) const;
  std::int64_t sequence() const;
  std::size_t bytes() const;
  bool empty() const;  // nothing is valid

  // Replaces tiles in one step; a null or empty tile is dropped. Called in sequence order.
  void put(const TileMap& tiles, std::int64_t sequence);
  // Replaces everything.
  void assign(TileMap tiles, std::int64_t sequence);

  // Taken before an edit is given to the GPU and given back once `put` has brought what it did, or
  // it was refused: meanwhile the GPU may hold what the mirror does not. The hold may outlive the
  // mirror.
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
