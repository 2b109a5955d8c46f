#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace strata::mesh {

struct BoundingSphere {
  glm::vec3 center{0};
  float radius = -1;  // -1: empty
};

// The occupied 8 × 8 blocks of a surface map, ordered by their position on the model. The time of a
// search in a small part of space is proportional to that part. It does not depend on the size of
// the map and the mesh. Neighbors in the atlas may be far apart on the model. A block in which
// distant islands meet is therefore divided into several parts.
struct BlockTree {
  static constexpr std::size_t kChildren = 8;

  struct Part {
    std::uint32_t slot = 0;
    std::uint16_t tile = 0;     // row-major
    std::uint8_t place = 0;     // position of the block in its tile: x | y << 4
    bool shares_block = false;  // with other parts
  };
  std::vector<Part> parts;
  // levels[0] bounds one part per entry. levels[i] bounds a run of eight entries of levels[i - 1].
  // The last level has one entry, or no entry if no part exists.
  std::vector<std::vector<BoundingSphere>> levels;

  std::size_t bytes() const;
};

// Builds a tree from parts with their bounds. The result does not depend on the number of threads.
struct BoundedPart {
  BlockTree::Part part;
  BoundingSphere bounds;
};
BlockTree build_block_tree(std::vector<BoundedPart> parts, float slack, int threads);

// Adds the parts of a block, or only `whole` if the block is one part. Texels separated by an empty
// gap of `least_gap` belong to different parts. `positions` has the 64 positions of the block, and
// only the positions in `owned` are used. Every bound is enlarged by `slack`.
void add_parts_of_block(BoundedPart whole, const glm::vec3* positions, std::uint64_t owned,
                        float least_gap, float slack, std::vector<BoundedPart>& parts);

// Returns a sphere around the texels of `owned`.
BoundingSphere bounds_of(const glm::vec3* positions, std::uint64_t owned, float slack);

}  // namespace strata::mesh
