#include "query/statistics/pieces.h"

#include <vector>

#include "domain/people/question.h"
#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_values.h"
#include "query/regions/texel_sets.h"

namespace strata::query {

PieceCounts count_pieces(const LayerView& view, const mesh::SurfaceMap& map,
                         const mesh::TexelGraph& graph, const TexelSelection* within,
                         const ValueClasses& classes) {
  const ValueType type = view.layer.type;
  const bool is_one = !classes.each && classes.limits.empty();
  const std::size_t texels = map.block_of_slot.size() * 64;
  const QuestionMemory memory(texels * sizeof(std::uint32_t) * (is_one ? 1 : 2));
  const QuestionTurn turn;
  TexelSets sets(texels);
  std::vector<std::uint32_t> class_of(is_one ? 0 : texels);
  for (const auto& [address, tile] : view.snapshot.tiles) {
    turn.check(kTexelsPerTile);
    for_each_value(*tile, address, type, map, within,
                   [&](std::uint32_t slot, int texel, std::uint32_t bits, double value) {
                     const std::uint32_t number = slot * 64 + static_cast<std::uint32_t>(texel);
                     sets.add(number);
                     if (!is_one) class_of[number] = classes.of(bits, value);
                   });
  }
  for (std::uint32_t texel = 0; texel < texels; ++texel) {
    if (texel % kTexelsPerTile == 0) turn.check(kTexelsPerTile);
    if (!sets.has(texel)) continue;
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      if (other < texel && sets.has(other) && (is_one || class_of[other] == class_of[texel]))
        sets.join(texel, other);
    });
  }
  PieceCounts counts;
  for (std::uint32_t texel = 0; texel < texels; ++texel) {
    if (!sets.has(texel) || !sets.is_root(texel)) continue;
    ++counts.all;
    ++counts.of_class[is_one ? 0 : class_of[texel]];
  }
  return counts;
}

}  // namespace strata::query
