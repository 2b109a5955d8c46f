#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "mesh/texels/texel_graph.h"

namespace strata::query {

// Calls visit(other) for the texels that touch a texel at a side or at a corner: the eight texels
// around it within a chart. Across a seam, two texels touch at a corner if both are connected to a
// third one (mesh::TexelGraph) that is not between them in a straight line. Near seams, calls it
// more than once for some texels.
template <class Visit>
void for_each_touching(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                       std::uint32_t texel, Visit&& visit) {
  using mesh::kNoNeighbour;
  using mesh::Way;
  constexpr std::array kWays{Way::right, Way::upper, Way::left, Way::lower};  // around the texel
  const auto step = [&](std::uint32_t from, Way way) {
    return from == kNoNeighbour ? from : mesh::neighbour(map, graph, from, way);
  };
  const auto has_links = [&](std::uint32_t of) {
    return (graph.has_links[of / 64] >> of % 64 & 1u) != 0;
  };
  const auto place = [&](std::uint32_t of) {
    return map.position(of / 64, static_cast<int>(of % 64));
  };
  const auto visit_corner = [&](std::uint32_t between, std::uint32_t other) {
    if (other == texel) return;
    constexpr float kCorner = 0.85f;  // of the two steps; √½ at a corner, 1 in a straight line
    const glm::vec3 from = place(texel), over = place(between), to = place(other);
    if (glm::distance(from, to) < kCorner * (glm::distance(from, over) + glm::distance(over, to)))
      visit(other);
  };
  std::array<std::uint32_t, 4> sides{};
  for (std::size_t k = 0; k < 4; ++k) {
    sides[k] = step(texel, kWays[k]);
    if (sides[k] != kNoNeighbour) visit(sides[k]);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    std::uint32_t corner = step(sides[k], kWays[next]);
    if (corner == kNoNeighbour) corner = step(sides[next], kWays[k]);
    if (corner != kNoNeighbour) visit(corner);
    if (sides[k] != kNoNeighbour && has_links(sides[k]))
      for (const auto& [side, other] : graph.links_of(sides[k])) visit_corner(side, other);
  }
  if (!has_links(texel)) return;
  for (const auto& [from, side] : graph.links_of(texel)) {
    visit(side);
    mesh::for_each_neighbour(map, graph, side, [&, between = side](std::uint32_t other) {
      visit_corner(between, other);
    });
  }
}

}  // namespace strata::query
