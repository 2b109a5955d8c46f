#include "query/statistics/surface_keys.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "query/conditions/texel_values.h"

namespace strata::query {
namespace {

// The sums of consecutive texels with one key in one block. A run has at most 64 texels, so only
// the sums over runs need to be compensated.
struct Run {
  std::uint32_t bits = 0;
  mesh::SurfaceMap::SlotSums sums;
};

class KeysOfRuns {
 public:
  void add(const Run& run) {
    if (run.sums.texels == 0) return;
    if (keys_.empty() || keys_[last_].bits != run.bits) {
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      const auto [found, fresh] = index_.try_emplace(run.bits, keys_.size());
      if (fresh)
        keys_.push_back(
            {run.bits, 0, 0, glm::dvec3(0), glm::dvec3(kInfinity), glm::dvec3(-kInfinity)});
      last_ = found->second;
    }
    keys_[last_].add({run.bits, run.sums.texels, run.sums.area, run.sums.weighted_position,
                      glm::dvec3(run.sums.lowest), glm::dvec3(run.sums.highest)});
  }
  std::vector<TileSums::Key> take() {
    std::ranges::sort(keys_, {}, &TileSums::Key::bits);
    return std::move(keys_);
  }

 private:
  std::vector<TileSums::Key> keys_;
  std::unordered_map<std::uint32_t, std::size_t> index_;
  std::size_t last_ = 0;  // neighboring runs mostly share a key
};

// Returns whether all these texels of a block have the same bits.
template <class Bits>
bool are_equal(const TileData& tile, std::uint64_t texels, int corner) {
  const auto first = bits_in_block<Bits>(tile, corner, std::countr_zero(texels));
  for (; texels != 0; texels &= texels - 1)
    if (bits_in_block<Bits>(tile, corner, std::countr_zero(texels)) != first) return false;
  return true;
}

template <class Bits>
std::vector<TileSums::Key> keys_of(const TileData& tile, TileAddress address, const Layer& layer,
                                   const mesh::SurfaceMap& map) {
  const bool apart = tells_keys_apart(layer);
  const double* values = values_of_bits(layer.type);
  const auto is_finite = [&](Bits bits) {
    return std::isfinite(values == nullptr ? decode_value(layer.type, bits) : values[bits]);
  };
  KeysOfRuns keys;
  for_each_block_of(
      tile, address, map, nullptr, [&](std::uint32_t slot, std::uint64_t texels, int corner) {
        Run run;
        if (texels == map.surface_mask[slot] && are_equal<Bits>(tile, texels, corner)) {
          const auto bits = bits_in_block<Bits>(tile, corner, std::countr_zero(texels));
          if (is_finite(bits)) keys.add({apart ? bits : 0u, map.sums_of_slot[slot]});
          return;
        }
        for (; texels != 0; texels &= texels - 1) {
          const int texel = std::countr_zero(texels);
          const auto bits = bits_in_block<Bits>(tile, corner, texel);
          if (!is_finite(bits)) continue;
          if (apart && bits != run.bits) {
            keys.add(run);
            run = {bits, {}};
          }
          map.add_texel(run.sums, slot, texel);
        }
        keys.add(run);
      });
  return keys.take();
}

}  // namespace

bool tells_keys_apart(const Layer& layer) {
  return layer.kind == LayerKind::database || bytes_per_texel(layer.type) == 1;
}

std::vector<TileSums::Key> surface_keys(const TileData& tile, TileAddress address,
                                        const Layer& layer, const mesh::SurfaceMap& map) {
  switch (bytes_per_texel(layer.type)) {
    case 1: return keys_of<std::uint8_t>(tile, address, layer, map);
    case 2: return keys_of<std::uint16_t>(tile, address, layer, map);
    default: return keys_of<std::uint32_t>(tile, address, layer, map);
  }
}

}  // namespace strata::query
