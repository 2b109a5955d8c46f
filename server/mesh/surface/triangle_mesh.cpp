#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

double surface_area(const TriangleMesh& mesh) {
  double twice = 0;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    const glm::dvec3& a = mesh.positions[mesh.triangles[i]];
    const glm::dvec3& b = mesh.positions[mesh.triangles[i + 1]];
    const glm::dvec3& c = mesh.positions[mesh.triangles[i + 2]];
    twice += glm::length(glm::cross(b - a, c - a));
  }
  return twice / 2;
}

}  // namespace strata::mesh
