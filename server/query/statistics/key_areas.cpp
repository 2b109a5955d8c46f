#include "query/statistics/key_areas.h"

#include <stdexcept>
#include <unordered_map>

#include "domain/people/question.h"
#include "query/conditions/texel_values.h"

namespace strata::query {

namespace {

TileSums::Key texel_key(const mesh::SurfaceMap& map, std::uint32_t slot, int texel,
                        std::uint32_t bits) {
  const double area = map.area[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)];
  const glm::dvec3 position(map.position(slot, texel));
  return {bits, 1, area, area * position, position, position};
}

}  // namespace

std::map<std::int64_t, KeyArea> key_areas(const LayerView& view, const mesh::SurfaceMap& map,
                                          const glm::dvec3& origin, double metres_per_unit,
                                          TileSumsCache* cache) {
  if (map.resolution != view.layer.resolution)
    throw std::invalid_argument("The surface map has another resolution than the layer.");
  std::unordered_map<std::uint32_t, TileSums::Key> sums;
  const auto add = [&](const TileSums::Key& key) {
    if (const auto [found, fresh] = sums.try_emplace(key.bits, key); !fresh) found->second.add(key);
  };
  const QuestionTurn turn;
  for (const auto& [address, tile] : view.snapshot.tiles) {
    turn.check(kTexelsPerTile);
    const auto make = [&] { return sum_tile(*tile, address, view.layer.type, map, nullptr); };
    const auto counted =
        cache ? cache->sums(address, tile, make) : std::make_shared<const TileSums>(make());
    for (const TileSums::Key& key : counted->keys) add(key);
    if (counted->too_many_keys)
      for_each_value(*tile, address, view.layer.type, map, nullptr,
                     [&](std::uint32_t slot, int texel, std::uint32_t bits, double) {
                       add(texel_key(map, slot, texel, bits));
                     });
  }
  std::map<std::int64_t, KeyArea> areas;
  for (const auto& [bits, sum] : sums)
    areas[bits] = {sum.texels, sum.area.value() * metres_per_unit * metres_per_unit,
                   sum.lowest + origin, sum.highest + origin};
  return areas;
}

}  // namespace strata::query
