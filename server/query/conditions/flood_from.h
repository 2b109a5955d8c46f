#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "domain/layers/tile.h"
#include "domain/people/question.h"
#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_selection.h"

namespace strata::query {

// Selects the texels that are connected to one of `starts` through texels for which
// `belongs(texel)` is true. Calls `belongs` once for each texel at most.
template <class Belongs>
TexelSelection flood_from(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                          std::span<const std::uint32_t> starts, Belongs belongs) {
  TexelSelection selection(map.block_of_slot.size(), 0), tested(selection);
  std::vector<std::uint32_t> open;
  const auto take = [&](std::uint32_t texel) {
    const std::uint64_t bit = std::uint64_t{1} << (texel % 64);
    if ((tested[texel / 64] & bit) != 0) return;
    tested[texel / 64] |= bit;
    if (!belongs(texel)) return;
    selection[texel / 64] |= bit;
    open.push_back(texel);
  };
  for (const std::uint32_t start : starts) take(start);
  const QuestionTurn turn;
  for (std::size_t done = 0; !open.empty(); ++done) {
    if (done % kTexelsPerTile == 0) turn.check(kTexelsPerTile);
    const std::uint32_t texel = open.back();
    open.pop_back();
    mesh::for_each_neighbour(map, graph, texel, take);
  }
  return selection;
}
template <class Belongs>
TexelSelection flood_from(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                          std::uint32_t start, Belongs belongs) {
  return flood_from(map, graph, std::span(&start, 1), std::move(belongs));
}

}  // namespace strata::query
