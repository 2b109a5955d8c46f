#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::bench {

// The octree OCT-TR (Torres et al. 2010), as the paper describes it. A cube around the model is
// divided into eight parts, and each part again, down to a given depth. The leaves are the cells
// that the surface crosses. A layer has one value for each leaf, in the order of the leaves. The
// tree is small and quick to traverse: an inner node takes 8 bytes, and leaves are in Morton order
// without nodes or lists of triangles.
class Octree {
 public:
  struct Node {
    std::uint32_t first;  // the first child: a node of the next level, or a leaf
    std::uint32_t mask;   // bit x | y << 1 | z << 2: this child exists
  };

  // Builds a tree of depth 1 to 15. Returns an Error if main memory is too small; its detail names
  // the needed amount.
  static Result<Octree> build(const mesh::Geometry& geometry, int depth, int threads);

  int depth() const { return static_cast<int>(levels_.size()); }
  const std::vector<Node>& level(int depth) const {
    return levels_[static_cast<std::size_t>(depth)];
  }
  std::size_t leaf_count() const { return leaf_count_; }
  std::size_t bytes() const;
  // The cube in model space.
  glm::vec3 low() const { return low_; }
  float side() const { return side_; }
  float cell_side() const { return side_ / static_cast<float>(1u << depth()); }
  std::vector<glm::uvec3> leaf_cells() const;  // by traversal, for tests

 private:
  glm::vec3 low_{0};
  float side_ = 1;
  std::size_t leaf_count_ = 0;
  std::vector<std::vector<Node>> levels_;  // the first level has only the root
};

}  // namespace strata::bench
