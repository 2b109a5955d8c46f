#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/error.h"
#include "mesh/texels/surface_map.h"

namespace strata::mesh {

// The connections between the surface texels of a map. A texel is connected to its four neighbors
// in the atlas if they belong to the same island. Links connect other texels that touch each other
// on the surface. Links are made along the mesh's edges. They run across seams, from the texels of
// one side to the texels of the other. They also run within an island that is thinner than a texel.
// Texels are numbered as in the arrays of the map: 64 * slot + y * 8 + x.
//
// A gap narrower than a texel within an island does not separate the texels on its two sides. An
// island without a surface texel connects nothing.
struct TexelGraph {
  std::vector<std::uint64_t> to_right,
      // per slot: bits of the texels that are connected to their right or upper neighbor
      to_upper;
  std::vector<std::uint64_t> has_links;     // per slot: bits of the texels with a link
  std::vector<std::uint64_t> at_open_edge;  // per slot: bits of the texels at which the mesh ends
  using Link = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Link> links;  // ascending, each listed in both directions

  std::span<const Link> links_of(std::uint32_t texel) const;
  std::size_t linked_texels() const;  // number of texels with a link
  std::size_t bytes() const;
};

// `map` belongs to this geometry. Fails when cancelled.
Result<TexelGraph> build_texel_graph(const Geometry& geometry, const SurfaceMap& map,
                                     Progress& progress, int threads = 2);

// Returns the surface texel at a texture coordinate. In a gutter, returns the surface texel that
// the gutter texel copies. Returns nothing if the atlas is empty there.
std::optional<std::uint32_t> surface_texel_at(const SurfaceMap& map, glm::vec2 uv);

enum class Way { right, upper, left, lower };
constexpr std::uint32_t kNoNeighbour = 0xffffffffu;

// Returns the texel next to another texel in the atlas if both are connected. Otherwise returns
// kNoNeighbour.
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

// Calls visit(neighbor) for each texel connected to `texel`.
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
