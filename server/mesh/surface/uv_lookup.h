#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Where texture coordinates lie on the surface, to the precision of the mesh: a surface map knows
// the middles of texels alone. Keeps a grid of the triangles, some 20 bytes each; `geometry` must
// live as long.
class UvLookup {
 public:
  explicit UvLookup(const Geometry& geometry);

  // Model space, in double: of the triangle that holds the coordinates, or the one that is nearest
  // to them in their cell of the grid; nothing where there is none.
  std::optional<glm::dvec3> place_at(glm::dvec2 uv) const;

 private:
  int cell_of(double coordinate) const;
  template <class Visit>
  void for_each_cell(std::size_t triangle, Visit&& visit) const;

  const Geometry& geometry_;
  int side_;                          // cells
  std::vector<std::uint32_t> first_;  // a cell; and the end
  std::vector<std::uint32_t> triangles_;
};

}  // namespace strata::mesh
