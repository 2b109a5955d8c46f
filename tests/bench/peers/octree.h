#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::bench {

// OCT-TR (Torres et al. 2010, as the paper describes its rival): the cube around a model is divided
// by eight down to a depth, and the leaves are the cells that the surface crosses. A layer is one
// value a leaf, in the order of the leaves. Kept small and quick to walk: 8 bytes an inner node,
// leaves in Morton order without any node of their own, no lists of triangles.
class Octree {
 public:
  struct Node {
    std::uint32_t first;  // child: of the next level, or a leaf
    std::uint32_t mask;   // bit x | y << 1 | z << 2: that child is there
  };

  // Depth 1 to 15. An Error where main memory would not do: its detail says how much is needed.
  static Result<Octree> build(const mesh::Geometry& geometry, int depth, int threads);

  int depth() const { return static_cast<int>(levels_.size()); }
  const std::vector<Node>& level(int depth) const {
    return levels_[static_cast<std::size_t>(depth)];
  }
  std::size_t leaf_count() const { return leaf_count_; }
  std::size_t bytes() const;
  // Model space.
  glm::vec3 low() const { return low_; }
  float side() const { return side_; }
  float cell_side() const { return side_ / static_cast<float>(1u << depth()); }
  std::vector<glm::uvec3> leaf_cells() const;  // by walking: for tests

 private:
  glm::vec3 low_{0};
  float side_ = 1;
  std::size_t leaf_count_ = 0;
  std::vector<std::vector<Node>> levels_;  // the root alone first
};

}  // namespace strata::bench
