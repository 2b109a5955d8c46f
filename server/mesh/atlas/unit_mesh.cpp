#include "mesh/atlas/unit_mesh.h"

#include <algorithm>

namespace strata::mesh {

UnitMesh to_unit_mesh(const TriangleMesh& mesh) {
  UnitMesh unit;
  unit.triangles = mesh.triangles;
  unit.positions.resize(mesh.positions.size());
  if (mesh.positions.empty()) return unit;
  glm::dvec3 low = mesh.positions.front(), high = low;
  for (const auto& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::dvec3 centre = low + (high - low) * 0.5, extent = high - low;
  const double side = std::max({extent.x, extent.y, extent.z});
  unit.units_per_unit = side > 0 ? side : 1;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    unit.positions[i] = glm::vec3((mesh.positions[i] - centre) / unit.units_per_unit);
  return unit;
}

FaceFrames face_frames(std::span<const std::uint32_t> triangles,
                       std::span<const glm::vec3> positions) {
  FaceFrames frames;
  const std::size_t count = triangles.size() / 3;
  frames.normals.resize(count);
  frames.areas.resize(count);
  for (std::size_t f = 0; f < count; ++f) {
    const glm::vec3 a = positions[triangles[3 * f]];
    const glm::dvec3 ab = positions[triangles[3 * f + 1]] - a,
                     ac = positions[triangles[3 * f + 2]] - a;
    const glm::dvec3 normal = glm::cross(ab, ac);
    const double length = glm::length(normal);
    // The face is too thin for float positions to distinguish it from a line.
    const double longest = std::max(glm::dot(ab, ab), glm::dot(ac, ac));
    if (length <= longest * 1e-7) continue;
    frames.normals[f] = glm::vec3(normal / length);
    frames.areas[f] = static_cast<float>(length / 2);
    frames.total_area += length / 2;
  }
  return frames;
}

std::vector<glm::vec3> averaged_normals(std::span<const std::uint32_t> triangles,
                                        std::size_t vertex_count, const FaceFrames& frames,
                                        int rounds) {
  const std::size_t count = triangles.size() / 3;
  std::vector<glm::vec3> of_face = frames.normals;
  std::vector<glm::vec3> at_vertex(vertex_count);
  for (int round = 0; round < rounds; ++round) {
    std::fill(at_vertex.begin(), at_vertex.end(), glm::vec3(0));
    for (std::size_t f = 0; f < count; ++f)
      for (int k = 0; k < 3; ++k) at_vertex[triangles[3 * f + k]] += of_face[f] * frames.areas[f];
    for (std::size_t f = 0; f < count; ++f) {
      const glm::vec3 sum = at_vertex[triangles[3 * f]] + at_vertex[triangles[3 * f + 1]] +
                            at_vertex[triangles[3 * f + 2]];
      const float length = glm::length(sum);
      if (length > 0) of_face[f] = sum / length;
    }
  }
  return of_face;
}

}  // namespace strata::mesh
