#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Finds the position of texture coordinates on the surface with the precision of the mesh. A
// surface map has only the centers of texels. Stores a grid of the triangles with about 20 bytes
// per triangle. `geometry` must outlive this object.
class UvLookup {
 public:
  explicit UvLookup(const Geometry& geometry);

  // Returns the position in model space, in double precision. It is on the triangle that contains
  // the coordinates, or on the nearest triangle in their cell of the grid. Returns nothing if the
  // cell is empty.
  std::optional<glm::dvec3> place_at(glm::dvec2 uv) const;

 private:
  int cell_of(double coordinate) const;
  template <class Visit>
  void for_each_cell(std::size_t triangle, Visit&& visit) const;

  const Geometry& geometry_;
  int side_;                          // number of cells
  std::vector<std::uint32_t> first_;  // one entry for each cell and one for the end
  std::vector<std::uint32_t> triangles_;
};

}  // namespace strata::mesh
