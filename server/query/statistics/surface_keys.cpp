#include "query/statistics/surface_keys.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "mesh/texels/packed_position.h"
#include "query/conditions/texel_values.h"

namespace strata::query {
namespace {

// The sums of consecutive texels with one key in one block. A block has 64 texels, and doubles add
// so few floats without a loss, so only the sums of runs need to be compensated.
struct Run {
  std::uint32_t slot = mesh::kNoSlot, bits = 0;
  std::uint64_t texels = 0;
  double area = 0;
  glm::dvec3 weighted_position{0};  // sum of area × position
  glm::vec3 lowest{std::numeric_limits<float>::infinity()};
  glm::vec3 highest{-std::numeric_limits<float>::infinity()};
};

class KeysOfRuns {
 public:
  void add(const Run& run) {
    if (run.texels == 0) return;
    if (keys_.empty() || keys_[last_].bits != run.bits) {
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      const auto [found, fresh] = index_.try_emplace(run.bits, keys_.size());
      if (fresh)
        keys_.push_back(
            {run.bits, 0, 0, glm::dvec3(0), glm::dvec3(kInfinity), glm::dvec3(-kInfinity)});
      last_ = found->second;
    }
    keys_[last_].add({run.bits, run.texels, run.area, run.weighted_position, glm::dvec3(run.lowest),
                      glm::dvec3(run.highest)});
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

}  // namespace

bool tells_keys_apart(const Layer& layer) {
  return layer.kind == LayerKind::database || bytes_per_texel(layer.type) == 1;
}

std::vector<TileSums::Key> surface_keys(const TileData& tile, TileAddress address,
                                        const Layer& layer, const mesh::SurfaceMap& map) {
  const bool apart = tells_keys_apart(layer);
  KeysOfRuns keys;
  Run run;
  for_each_value(tile, address, layer.type, map, nullptr,
                 [&](std::uint32_t slot, int texel, std::uint32_t all_bits, double) {
                   const std::uint32_t bits = apart ? all_bits : 0;
                   if (slot != run.slot || bits != run.bits) {
                     keys.add(run);
                     run = {.slot = slot, .bits = bits};
                   }
                   const std::size_t place =
                       std::size_t{slot} * 64 + static_cast<std::size_t>(texel);
                   const double area = map.area[place];
                   const glm::vec3 position =
                       mesh::unpack_position(map.packed_position[place], map.packed_box[slot]);
                   ++run.texels;
                   run.area += area;
                   run.weighted_position += area * glm::dvec3(position);
                   run.lowest = glm::min(run.lowest, position);
                   run.highest = glm::max(run.highest, position);
                 });
  keys.add(run);
  return keys.take();
}

}  // namespace strata::query
