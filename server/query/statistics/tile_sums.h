#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "core/compensated_sum.h"
#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"

namespace strata::mesh {
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

constexpr std::size_t kMaxStatisticsKeys = 4096;
constexpr int kHistogramBins = 64;

// The contribution of the valid surface texels of one tile to the statistics of a layer, in model
// units. Sums of two tiles are combined without loss (Chan, Golub, LeVeque 1983), so after a
// stroke, only its tiles are summed again.
struct TileSums {
  std::uint64_t texels = 0;
  CompensatedSum area;
  double min = 0, max = 0;
  CompensatedSum weighted;  // sum of area × value
  double squares = 0;       // sum of area × (value − mean)²
  struct Key {
    std::uint32_t bits = 0;
    std::uint64_t texels = 0;
    CompensatedSum area;
    glm::dvec3 weighted_position{0};  // sum of area × position
    glm::dvec3 lowest{0}, highest{0};
    void add(const Key& other);
  };
  // for integer types, ascending by bits; empty if there are more than kMaxStatisticsKeys
  std::vector<Key> keys;
  bool too_many_keys = false;

  // Returns the mean weighted by area, or the middle of the range if there is no area.
  double mean() const;
};
TileSums sum_tile(const TileData& tile, TileAddress address, ValueType type,
                  const mesh::SurfaceMap& map, const TexelSelection* within);

// A histogram with bins of equal width over [min, max] of the whole layer.
struct TileHistogram {
  double min = 0, max = 0;
  std::array<std::uint64_t, kHistogramBins> texels{};
  std::array<double, kHistogramBins> area{};
};
inline int bin_of(double value, double min, double max) {
  return max > min ? std::min(kHistogramBins - 1,
                              static_cast<int>((value - min) / (max - min) * kHistogramBins))
                   : 0;
}
TileHistogram count_tile(const TileData& tile, TileAddress address, ValueType type,
                         const mesh::SurfaceMap& map, const TexelSelection* within, double min,
                         double max);

// Keeps the sums of the tiles of one layer until the tiles change. Thread-safe.
class TileSumsCache {
 public:
  // Returns the sums of the tile. Calls `make` if the tile has changed.
  template <class Make>
  std::shared_ptr<const TileSums> sums(TileAddress address,
                                       const std::shared_ptr<const TileData>& tile, Make make) {
    {
      std::lock_guard lock(mutex_);
      if (const Entry& entry = entries_[address]; entry.sums && is_of(entry, tile))
        return entry.sums;
    }
    auto made = std::make_shared<const TileSums>(make());
    std::lock_guard lock(mutex_);
    if (made->keys.size() <= kMaxKeptKeys) entries_[address] = {tile, made, nullptr};
    return made;
  }
  // Returns the histogram of the tile. Calls `make` if the tile or the limits have changed.
  template <class Make>
  std::shared_ptr<const TileHistogram> histogram(TileAddress address,
                                                 const std::shared_ptr<const TileData>& tile,
                                                 double min, double max, Make make) {
    {
      std::lock_guard lock(mutex_);
      const Entry& entry = entries_[address];
      if (entry.histogram && is_of(entry, tile) && entry.histogram->min == min &&
          entry.histogram->max == max)
        return entry.histogram;
    }
    auto made = std::make_shared<const TileHistogram>(make());
    std::lock_guard lock(mutex_);
    if (Entry& entry = entries_[address]; is_of(entry, tile)) entry.histogram = made;
    return made;
  }

 private:
  static constexpr std::size_t kMaxKeptKeys = 256;  // 25 KB per tile
  struct Entry {
    std::weak_ptr<const TileData> tile;  // a tile never changes; a new one replaces it
    std::shared_ptr<const TileSums> sums;
    std::shared_ptr<const TileHistogram> histogram;
  };
  static bool is_of(const Entry& entry, const std::shared_ptr<const TileData>& tile) {
    return !entry.tile.owner_before(tile) && !tile.owner_before(entry.tile);
  }

  std::mutex mutex_;
  std::unordered_map<TileAddress, Entry> entries_;
};

}  // namespace strata::query
