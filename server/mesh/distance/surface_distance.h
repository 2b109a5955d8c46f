#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "core/error.h"
#include "mesh/texels/texel_graph.h"

namespace strata {
class Progress;
}

namespace strata::mesh {

// A bit of a source texel: the distance was measured from a front of several sources, of which this
// one is the nearest.
constexpr std::uint32_t kManySources = 1u << 31;

struct TexelDistance {
  float distance = std::numeric_limits<float>::infinity();  // in model units; infinity: not reached
  std::uint32_t source = kNoNeighbour;
};

// The distance of each texel from the nearest of a set of source texels, along the surface. Texels
// are numbered as in TexelGraph. Distances are in model units, between the centers of texels.
class SurfaceDistances {
 public:
  // Returns 0 for a source texel, and infinity if the texel was not reached: because it is farther
  // than the limit, or because its piece of the surface contains no source.
  float at(std::uint32_t texel) const { return stored(texel).distance; }
  // Returns the nearest source texel, or kNoNeighbour if the texel was not reached. If several
  // sources are almost equally near, returns one of them.
  std::uint32_t source_of(std::uint32_t texel) const {
    const TexelDistance found = stored(texel);
    return found.source == kNoNeighbour ? kNoNeighbour : found.source & ~kManySources;
  }
  bool is_source(std::uint32_t texel) const {
    return (sources_[texel / 64] >> texel % 64 & 1u) != 0;
  }
  // Returns the texels of a slot that were reached, sources included.
  std::uint64_t reached_in(std::uint32_t slot) const;
  std::uint64_t reached_texels() const;
  std::size_t bytes() const;

 private:
  friend class FrontRounds;
  friend class BlockFront;
  struct Block {
    std::array<float, 64> distance;
    std::array<std::uint32_t, 64> source;
  };
  // As computed: the source may have kManySources.
  TexelDistance stored(std::uint32_t texel) const {
    const std::uint32_t block = block_of_slot_[texel / 64];
    if (block != kNoSlot)
      return {blocks_[block].distance[texel % 64], blocks_[block].source[texel % 64]};
    if (is_source(texel)) return {0, texel};
    return {};
  }
  bool has_block(std::uint32_t slot) const { return block_of_slot_[slot] != kNoSlot; }

  std::vector<std::uint64_t> sources_;        // one word per slot
  std::vector<std::uint32_t> block_of_slot_;  // index into blocks_, or kNoSlot
  std::deque<Block> blocks_;
};

// Computes the distances up to `limit` (model units; infinity: the whole surface) from the texels
// whose bits are set in `sources`, one word per slot, as in SurfaceMap::surface_mask. Bits of other
// texels are ignored. Without a source, no texel is reached.
//
// It is fast marching over the triangles of neighboring texels, in blocks of 8 × 8 texels: a block
// is computed again when the distance of a texel next to it becomes smaller (like the fast
// iterative method of Jeong and Whitaker, 2008). Blocks near the sources come first. Lengths are
// measured between the positions of texels, also across seams, so the distances do not depend on
// the atlas. The error is mostly at most 1 % of the distance, or 1.5 texels if that is more. Single
// texels at seams have the largest errors. Paths over sharp rims are up to two texels too short for
// each rim, because texels round it off. The errors grow with the ratio of the stretch of a chart.
// Beyond 20 texels from a point they are less than 0.1 % at ratio 2, 1 % at 3, 2 % at 4 and 4 % at
// 6, and up to 10 % in a chart sheared by 2. Greater ratios have no bound.
//
// Distances begin at the centers of source texels, so they are about half a texel too long from a
// painted border.
//
// The time is proportional to the number of texels reached. The result takes about 9 bytes for each
// texel of the blocks reached, and 12 bytes for each block of the atlas. While it runs, the
// function needs about 1 KiB more for each texel within two steps of a seam that it reaches
// (bytes() does not count them), and up to 10 MiB for the blocks of a round. The result does not
// depend on the number of threads. Fails when cancelled, and with `malformed` if the limit is
// negative or not a number. Checks the current question (domain/people/question.h).
Result<SurfaceDistances> distances_along_surface(const SurfaceMap& map, const TexelGraph& graph,
                                                 std::span<const std::uint64_t> sources,
                                                 double limit, Progress& progress, int threads = 2);

}  // namespace strata::mesh
