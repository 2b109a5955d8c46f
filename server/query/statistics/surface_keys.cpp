#include "query/statistics/surface_keys.h"

#include <limits>
#include <unordered_map>

#include "query/conditions/texel_values.h"

namespace strata::query {

bool tells_keys_apart(const Layer& layer) {
  return layer.kind == LayerKind::database || bytes_per_texel(layer.type) == 1;
}

std::vector<TileSums::Key> surface_keys(const TileData& tile, TileAddress address,
                                        const Layer& layer, const mesh::SurfaceMap& map) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const bool apart = tells_keys_apart(layer);
  std::vector<TileSums::Key> keys;
  std::unordered_map<std::uint32_t, std::size_t> index;
  std::size_t last = 0;  // neighboring texels mostly share a key
  for_each_value(tile, address, layer.type, map, nullptr,
                 [&](std::uint32_t slot, int texel, std::uint32_t all_bits, double) {
                   const std::uint32_t bits = apart ? all_bits : 0;
                   if (keys.empty() || keys[last].bits != bits) {
                     const auto [found, fresh] = index.try_emplace(bits, keys.size());
                     if (fresh)
                       keys.push_back({bits, 0, 0, glm::dvec3(0), glm::dvec3(kInfinity),
                                       glm::dvec3(-kInfinity)});
                     last = found->second;
                   }
                   const double area =
                       map.area[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)];
                   const glm::dvec3 position(map.position(slot, texel));
                   keys[last].add({bits, 1, area, area * position, position, position});
                 });
  std::ranges::sort(keys, {}, &TileSums::Key::bits);
  return keys;
}

}  // namespace strata::query
