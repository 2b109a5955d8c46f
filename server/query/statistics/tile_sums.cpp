#include "query/statistics/tile_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "query/conditions/texel_values.h"

namespace strata::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The sums of the keys of one tile. Neighboring texels mostly share a value, so a run of texels is
// summed before its key is looked up.
class KeySums {
 public:
  explicit KeySums(const mesh::SurfaceMap& map) : map_(map) {}

  void add(std::uint32_t slot, int texel, std::uint32_t bits, double area) {
    if (run_.texels == 0 || bits != run_.bits) {
      end_run();
      run_ = {bits, 0, 0, glm::dvec3(0), glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
    }
    const glm::dvec3 position(map_.position(slot, texel));
    ++run_.texels;
    run_.area += area;
    run_.weighted_position += area * position;
    run_.lowest = glm::min(run_.lowest, position);
    run_.highest = glm::max(run_.highest, position);
  }

  void finish(TileSums& sums) {
    end_run();
    sums.too_many_keys = too_many_;
    if (too_many_) return;
    sums.keys = std::move(keys_);
    std::ranges::sort(sums.keys, {}, &TileSums::Key::bits);
  }

 private:
  void end_run() {
    if (run_.texels == 0 || too_many_) return;
    const auto [found, fresh] =
        index_.try_emplace(run_.bits, static_cast<std::uint32_t>(keys_.size()));
    if (!fresh)
      keys_[found->second].add(run_);
    else if (keys_.size() < kMaxStatisticsKeys)
      keys_.push_back(run_);
    else
      too_many_ = true;
  }

  const mesh::SurfaceMap& map_;
  TileSums::Key run_;
  std::vector<TileSums::Key> keys_;
  std::unordered_map<std::uint32_t, std::uint32_t> index_;
  bool too_many_ = false;
};

}  // namespace

void TileSums::Key::add(const Key& other) {
  texels += other.texels;
  area += other.area;
  weighted_position += other.weighted_position;
  lowest = glm::min(lowest, other.lowest);
  highest = glm::max(highest, other.highest);
}

double TileSums::mean() const {
  if (!(area.value() > 0)) return (min + max) / 2;
  // the mean of equal values must be that value, in spite of rounding
  return std::clamp(weighted.value() / area.value(), min, max);
}

TileSums sum_tile(const TileData& tile, TileAddress address, ValueType type,
                  const mesh::SurfaceMap& map, const TexelSelection* within) {
  TileSums sums;
  sums.min = kInfinity;
  sums.max = -kInfinity;
  KeySums keys(map);
  const bool has_keys = !is_float(type);
  // Sums of differences from one value of the tile lose no precision if all values are similar.
  double near = 0, differences = 0, squares = 0;
  for_each_value(tile, address, type, map, within,
                 [&](std::uint32_t slot, int texel, std::uint32_t bits, double value) {
                   const double area =
                       map.area[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)];
                   if (sums.texels++ == 0) near = value;
                   const double difference = value - near;
                   sums.area += area;
                   sums.weighted += area * value;
                   differences += area * difference;
                   squares += area * difference * difference;
                   sums.min = std::min(sums.min, value);
                   sums.max = std::max(sums.max, value);
                   if (has_keys) keys.add(slot, texel, bits, area);
                 });
  if (sums.texels == 0) return {};
  if (const double area = sums.area.value(); area > 0)
    sums.squares = std::max(0.0, squares - differences * differences / area);
  if (has_keys) keys.finish(sums);
  return sums;
}

TileHistogram count_tile(const TileData& tile, TileAddress address, ValueType type,
                         const mesh::SurfaceMap& map, const TexelSelection* within, double min,
                         double max) {
  TileHistogram histogram;
  histogram.min = min;
  histogram.max = max;
  for_each_value(tile, address, type, map, within,
                 [&](std::uint32_t slot, int texel, std::uint32_t, double value) {
                   const auto bin = static_cast<std::size_t>(bin_of(value, min, max));
                   ++histogram.texels[bin];
                   histogram.area[bin] +=
                       map.area[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)];
                 });
  return histogram;
}

}  // namespace strata::query
