#include "query/statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unordered_map>

#include "query/tile_table.h"

namespace strata::query {
namespace {

constexpr int kBins = 64;
constexpr std::size_t kMaxKeys = 4096;
constexpr int kBlocksPerTile = kTileSize / kBlockSize;

// Calls `visit(slot, texel in the block, bits)` for every valid surface texel, in the order of slots.
template <class Visit>
void for_each_texel(const TileTable& tiles, const mesh::SurfaceMap& map, Visit visit) {
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    const std::uint64_t surface = map.surface_mask[slot];
    if (surface == 0) continue;
    const int bx = static_cast<int>(map.block_of_slot[slot] % map.blocks_per_side);
    const int by = static_cast<int>(map.block_of_slot[slot] / map.blocks_per_side);
    const TileData* tile = tiles.of_block(bx, by);
    if (tile == nullptr) continue;
    const int corner = (by % kBlocksPerTile) * kBlockSize * kTileSize + (bx % kBlocksPerTile) * kBlockSize;
    for (std::uint64_t rest = surface; rest != 0; rest &= rest - 1) {
      const int texel = std::countr_zero(rest);
      const int in_tile = corner + texel / kBlockSize * kTileSize + texel % kBlockSize;
      if (tile->valid.test(in_tile)) visit(slot, texel, tile->bits(in_tile));
    }
  }
}

// Sums per distinct value; gives up beyond kMaxKeys.
class KeySums {
 public:
  KeySums(ValueType type, const mesh::SurfaceMap& map) : map_(map), active_(!is_float(type)) {
    if (active_ && bytes_per_texel(type) <= 2) small_.assign(std::size_t{1} << (8 * bytes_per_texel(type)), kNone);
  }

  void add(std::uint32_t slot, int texel, std::uint32_t bits, double area) {
    if (!active_) return;
    const std::uint32_t index = index_of(bits);
    if (index == kNone) return;
    Sum& sum = sums_[index];
    const glm::dvec3 position(map_.position(slot, texel));
    ++sum.texels;
    sum.area += area;
    sum.weighted_position += area * position;
    sum.lowest = glm::min(sum.lowest, position);
    sum.highest = glm::max(sum.highest, position);
  }

  std::map<double, KeyStatistics> finish(ValueType type, const glm::dvec3& origin, double m2_per_unit2) const {
    std::map<double, KeyStatistics> keys;
    if (!active_) return keys;
    for (const Sum& sum : sums_) {
      const glm::dvec3 centroid = sum.area > 0 ? sum.weighted_position / sum.area : (sum.lowest + sum.highest) / 2.0;
      keys[decode_value(type, sum.bits)] = {sum.texels, sum.area * m2_per_unit2, centroid + origin, sum.lowest + origin,
                                            sum.highest + origin};
    }
    return keys;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Sum {
    std::uint32_t bits = 0;
    std::uint64_t texels = 0;
    double area = 0;
    glm::dvec3 weighted_position{0};
    glm::dvec3 lowest{std::numeric_limits<double>::infinity()}, highest{-std::numeric_limits<double>::infinity()};
  };

  std::uint32_t index_of(std::uint32_t bits) {
    if (bits == last_bits_ && last_index_ != kNone) return last_index_;
    std::uint32_t& index = small_.empty() ? large_.try_emplace(bits, kNone).first->second : small_[bits];
    if (index == kNone) {
      if (sums_.size() == kMaxKeys) {
        active_ = false;
        return kNone;
      }
      index = static_cast<std::uint32_t>(sums_.size());
      sums_.emplace_back().bits = bits;
    }
    last_bits_ = bits;
    last_index_ = index;
    return index;
  }

  const mesh::SurfaceMap& map_;
  bool active_;
  std::vector<std::uint32_t> small_;  // 8 and 16 bit: index by the bits themselves
  std::unordered_map<std::uint32_t, std::uint32_t> large_;
  std::vector<Sum> sums_;
  std::uint32_t last_bits_ = 0, last_index_ = kNone;  // neighbours mostly share a value
};

}  // namespace

Statistics statistics(const LayerView& view, const mesh::SurfaceMap& map, const glm::dvec3& origin,
                      double metres_per_unit) {
  if (map.resolution != view.layer.resolution)
    throw std::invalid_argument("The surface map is of another resolution than the layer.");
  const ValueType type = view.layer.type;
  const double m2_per_unit2 = metres_per_unit * metres_per_unit;
  const TileTable tiles(view.snapshot.tiles, map.resolution);

  Statistics out;
  KeySums keys(type, map);
  double area = 0, weighted = 0;
  out.min = std::numeric_limits<double>::infinity();
  out.max = -out.min;
  for_each_texel(tiles, map, [&](std::uint32_t slot, int texel, std::uint32_t bits) {
    const double value = decode_value(type, bits);
    const double texel_area = map.area[std::size_t(slot) * 64 + texel];
    ++out.texels;
    area += texel_area;
    weighted += texel_area * value;
    out.min = std::min(out.min, value);
    out.max = std::max(out.max, value);
    keys.add(slot, texel, bits, texel_area);
  });
  if (out.texels == 0) return {};
  out.area_m2 = area * m2_per_unit2;
  // Rounding must not push the mean of a constant layer beyond its value.
  out.mean = area > 0 ? std::clamp(weighted / area, out.min, out.max) : (out.min + out.max) / 2;
  out.keys = keys.finish(type, origin, m2_per_unit2);

  // The spread needs the mean and the bins need the limits: a second pass is exact where running sums are not.
  const double range = out.max - out.min;
  const int bins = range > 0 ? kBins : 1;
  for (int i = 0; i < bins; ++i)
    out.histogram.push_back({out.min + range * i / bins, out.min + range * (i + 1) / bins, 0, 0});
  double squares = 0;
  for_each_texel(tiles, map, [&](std::uint32_t slot, int texel, std::uint32_t bits) {
    const double value = decode_value(type, bits);
    const double texel_area = map.area[std::size_t(slot) * 64 + texel];
    squares += texel_area * (value - out.mean) * (value - out.mean);
    auto& bin = out.histogram[bins == 1 ? 0 : std::min(bins - 1, static_cast<int>((value - out.min) / range * bins))];
    ++bin.texels;
    bin.area_m2 += texel_area * m2_per_unit2;
  });
  out.std = area > 0 ? std::sqrt(squares / area) : 0;
  return out;
}

}  // namespace strata::query
