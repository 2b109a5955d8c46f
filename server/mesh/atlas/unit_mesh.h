#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// A mesh moved to the origin and scaled so that its largest side is 1. It is the input for
// unwrapping, so models in millimeters, UTM meters and nanometers give equivalent results.
// Subtraction and scaling are computed in double precision.
struct UnitMesh {
  std::vector<glm::vec3> positions;
  std::span<const std::uint32_t> triangles;  // of the source mesh, which must outlive this object
  double units_per_unit = 1;                 // file units per unit of this mesh

  std::size_t triangle_count() const { return triangles.size() / 3; }
  glm::vec3 corner(std::uint32_t triangle, int k) const {
    return positions[triangles[3 * triangle + k]];
  }
};

UnitMesh to_unit_mesh(const TriangleMesh& mesh);

// The normals and areas of faces for given positions. A degenerate face has area 0 and normal 0.
struct FaceFrames {
  std::vector<glm::vec3> normals;
  std::vector<float> areas;
  double total_area = 0;
};
FaceFrames face_frames(std::span<const std::uint32_t> triangles,
                       std::span<const glm::vec3> positions);

// Returns the face normals averaged over neighbors `rounds` times, weighted by area. They follow
// the trend of the surface without its noise.
std::vector<glm::vec3> averaged_normals(std::span<const std::uint32_t> triangles,
                                        std::size_t vertex_count, const FaceFrames& frames,
                                        int rounds);

}  // namespace strata::mesh
