#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/texels/texel_graph.h"

namespace strata::query {

// Some texels of a block of the map.
struct BlockTexels {
  std::uint32_t slot;
  std::uint64_t bits;
};

// The connected texels in a ball around a texel, as bits of the blocks of 8 × 8 texels of the map.
// Distances are straight through space. Only texels count that are connected within the ball.
//
// A ball reads a whole block at once. Blocks are kept for the next balls, so balls around
// neighboring texels are fastest. Use each object on one thread.
class TexelBalls {
 public:
  // `radius` is in model units. A ball ends after about `max_texels` texels, and in atlases of
  // tiny charts after 256 + max_texels / 16 blocks. An object needs up to
  // 80 bytes of memory for each of them, and 300 KiB.
  TexelBalls(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, double radius,
             std::size_t max_texels);

  // Returns the blocks with texels in the ball. They are valid until the next call.
  std::span<const BlockTexels> around(std::uint32_t start);

  // Returns only the texels to which a path within the ball leads that is at most the radius long.
  // So it does not reach the other side of a fold or of a thin wall. Paths have steps like those of
  // a king in chess, so they may be up to 8 % longer. Takes about fifty times as long.
  std::span<const BlockTexels> on_paths(std::uint32_t start);

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu, kUnknown = 0xfffffffeu;
  struct Block {
    std::uint32_t slot;
    std::array<std::uint32_t, 4> beside;  // by mesh::Way: index in blocks_, kNone or kUnknown
    std::uint64_t surface, to_right, to_upper, linked;
    std::size_t first_link;
    glm::vec3 middle;
    float reach;  // all surface texels are at most this far from the middle
    std::array<float, 64> x, y, z;
    // In the current ball, if `ball` is its number:
    std::uint64_t ball;
    std::uint64_t inside;   // the texels within the radius
    std::uint64_t reached;  // those of them that are connected to the start
    std::uint64_t waiting;  // those that are reached from other blocks
    std::uint64_t walked;   // those whose path is short enough
    std::array<float, 64> lengths;
  };

  void fill(std::uint32_t start);
  void fill_once(std::uint32_t start);
  void spread(std::uint32_t index);
  void reach(std::uint32_t index, std::uint64_t bits);
  void walk(std::uint32_t start);
  // Calls visit(index, i) for the texels that are connected to texel i of a block.
  template <class Visit>
  void for_each_neighbour(std::uint32_t index, std::uint32_t i, Visit&& visit);
  std::uint64_t texels_inside(const Block& block) const;
  std::uint32_t beside(std::uint32_t index, mesh::Way way);
  // Returns kNone if there are too many blocks.
  std::uint32_t index_of(std::uint32_t slot);
  void read(std::uint32_t slot);
  void forget();

  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const float radius_;
  const std::size_t max_texels_, max_blocks_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> table_;  // hash table of indices in blocks_
  glm::vec3 center_{0};
  std::uint64_t ball_ = 0;
  std::size_t texels_ = 0;  // in the current ball
  std::vector<std::uint32_t> touched_, queue_;
  std::vector<BlockTexels> found_;
  std::vector<std::pair<float, std::uint32_t>> open_;  // length and 64 * index + i: a heap
};

}  // namespace strata::query
