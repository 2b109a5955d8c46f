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

// Returns the edges that belong to only one triangle: rims, breaks and holes. An edge is a pair of
// indices of welded positions. The edges are in the order of the triangles. An edge with three
// triangles is not a boundary edge.
std::vector<std::array<std::uint32_t, 2>> boundary_edges(const Geometry& geometry);

// The Euclidean distance to the nearest boundary edge, in model space. Thread-safe.
class BoundaryDistance {
 public:
  explicit BoundaryDistance(const Geometry& geometry);
  bool is_closed() const { return !tree_; }   // the model has no boundary
  float at(const glm::vec3& position) const;  // NaN for a closed model

 private:
  std::unique_ptr<SearchTree> tree_;  // holds the edges as triangles without area
};

}  // namespace strata::mesh
