#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/error.h"
#include "mesh/texels/surface_map.h"

namespace strata::mesh {

// Which surface texels of a map touch each other on the surface: the four neighbors of a texel in
// the atlas if they belong to the same island, and links where the atlas does not show it. Links
// are made along the mesh's edges: across seams, from one side's texels to the other's, and within
// an island where it is thinner than a texel. Texels are numbered as in the arrays of the map: 64 *
// slot + y * 8 + x.
//
// A gap within an island that is narrower than a texel does not separate its sides; an island
// without a surface texel joins nothing.
struct TexelGraph {
  std::vector<std::uint64_t> to_right,
      // a slot: bits of the texels that are joined to their right, upper neighbor
      to_upper;
  std::vector<std::uint64_t> has_links;     // a slot: bits of the texels that begin a link
  std::vector<std::uint64_t> at_open_edge;  // a slot: bits of the texels where the mesh ends
  using Link = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Link> links;  // ascending; each is listed in both directions

  std::span<const Link> links_of(std::uint32_t texel) const;
  std::size_t bytes() const;
};

// `map` is of this geometry. Refused when cancelled.
Result<TexelGraph> build_texel_graph(const Geometry& geometry, const SurfaceMap& map,
                                     Progress& progress, int threads = 2);

// The surface texel at a texture coordinate, or the one that the gutter there follows; nothing if
// the atlas is empty there.
std::optional<std::uint32_t> surface_texel_at(const SurfaceMap& map, glm::vec2 uv);

enum class Way { right, upper, left, lower };
constexpr std::uint32_t kNoNeighbour = 0xffffffffu;

// The texel next to another one in the atlas, if both are joined; otherwise kNoNeighbour.
inline std::uint32_t neighbour(const SurfaceMap& map, const TexelGraph& graph, std::uint32_t texel,
                               Way way) {
  const std::uint32_t slot = texel / 64, i = texel % 64, block = map.block_of_slot[slot];
  const auto side = static_cast<std::uint32_t>(map.blocks_per_side);
  const auto has = [](std::uint64_t bits, std::uint32_t index) {
    return ((bits >> index) & 1u) != 0;
  };
  switch (way) {
    case Way::right:
      if (!has(graph.to_right[slot], i)) return kNoNeighbour;
      return i % 8 < 7 ? texel + 1 : map.slot_of_block[block + 1] * 64 + i - 7;
    case Way::upper:
      if (!has(graph.to_upper[slot], i)) return kNoNeighbour;
      return i < 56 ? texel + 8 : map.slot_of_block[block + side] * 64 + i - 56;
    case Way::left: {
      if (i % 8 > 0) return has(graph.to_right[slot], i - 1) ? texel - 1 : kNoNeighbour;
      if (block % side == 0) return kNoNeighbour;
      const std::uint32_t left = map.slot_of_block[block - 1];
      return left != kNoSlot && has(graph.to_right[left], i + 7) ? left * 64 + i + 7 : kNoNeighbour;
    }
    case Way::lower: {
      if (i >= 8) return has(graph.to_upper[slot], i - 8) ? texel - 8 : kNoNeighbour;
      if (block < side) return kNoNeighbour;
      const std::uint32_t lower = map.slot_of_block[block - side];
      return lower != kNoSlot && has(graph.to_upper[lower], i + 56) ? lower * 64 + i + 56
                                                                    : kNoNeighbour;
    }
  }
  return kNoNeighbour;
}

// Calls visit(neighbor) for each texel joined to `texel`.
template <class Visit>
void for_each_neighbour(const SurfaceMap& map, const TexelGraph& graph, std::uint32_t texel,
                        Visit&& visit) {
  for (const Way way : {Way::right, Way::upper, Way::left, Way::lower})
    if (const std::uint32_t next = neighbour(map, graph, texel, way); next != kNoNeighbour)
      visit(next);
  if (((graph.has_links[texel / 64] >> texel % 64) & 1u) != 0)
    for (const TexelGraph::Link& link : graph.links_of(texel)) visit(link.second);
}

}  // namespace strata::mesh
