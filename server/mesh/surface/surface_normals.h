#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The normals of a mesh as a smooth surface. At each welded position the normal is the mean of the
// surrounding faces, weighted by their angle there. This pseudo-normal of Bærentzen and Aanæs also
// distinguishes inside from outside. The normals are interpolated over triangles. A triangle at
// more than 40° to the mean is at a real edge and keeps its own normal there. Immutable and
// thread-safe.
class SurfaceNormals {
 public:
  explicit SurfaceNormals(std::shared_ptr<const Geometry> geometry);

  glm::vec3 at_position(std::uint32_t position_index) const { return of_position_[position_index]; }
  glm::vec3 of_face(std::uint32_t triangle) const;  // 0 for a triangle without area
  glm::vec3 at_corner(std::uint32_t triangle, int k) const;
  glm::vec3 at(std::uint32_t triangle, const glm::vec3& weights) const;

 private:
  std::shared_ptr<const Geometry> geometry_;
  std::vector<glm::vec3> of_position_;
};

}  // namespace strata::mesh
