#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Finds the position of texture coordinates on the surface, to the precision of the mesh: a surface
// map has only the centers of texels. Keeps a grid of the triangles, some 20 bytes each; `geometry`
// must outlive it.
class UvLookup {
 public:
  explicit UvLookup(const Geometry& geometry);

  // The position in model space, in double, on the triangle that contains the coordinates, or on
  // the nearest one in their cell of the grid; nothing if the cell is empty.
  std::optional<glm::dvec3> place_at(glm::dvec2 uv) const;

 private:
  int cell_of(double coordinate) const;
  template <class Visit>
  void for_each_cell(std::size_t triangle, Visit&& visit) const;

  const Geometry& geometry_;
  int side_;                          // cells
  std::vector<std::uint32_t> first_;  // for each cell, and the end
  std::vector<std::uint32_t> triangles_;
};

}  // namespace strata::mesh
