#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/surface/geometry.h"
#include "mesh/surface/search_tree.h"

namespace strata::mesh {

// Edges that belong to one triangle only: rims, breaks, holes. Pairs of indices of welded
// positions, in the triangles' order. An edge of three triangles is not a boundary edge.
std::vector<std::array<std::uint32_t, 2>> boundary_edges(const Geometry& geometry);

// Euclidean distance to the nearest boundary edge, in model space. Thread-safe.
class BoundaryDistance {
 public:
  explicit BoundaryDistance(const Geometry& geometry);
  bool is_closed() const { return !tree_; }   // there is no boundary
  float at(const glm::vec3& position) const;  // NaN where the model is closed

 private:
  std::unique_ptr<SearchTree> tree_;  // over the edges, as triangles without area
};

}  // namespace strata::mesh
