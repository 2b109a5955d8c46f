#pragma once

#include <cmath>
#include <cstdlib>

#include "mesh/io/load.h"
#include "support/manifold_check.h"
#include "support/openmesh_oracle.h"

namespace strata::test {

// Checks the properties of every mesh that was read. The fuzzer reports an abort as a finding.
inline void check_loaded(const mesh::LoadedMesh& loaded) {
  const mesh::TriangleMesh& mesh = loaded.mesh;
  const auto demand = [](bool condition) {
    if (!condition) std::abort();
  };
  demand(!mesh.triangles.empty() && mesh.triangles.size() % 3 == 0);
  demand(mesh.corner_uvs.empty() || mesh.corner_uvs.size() == mesh.triangles.size());
  demand(mesh.vertex_colors.empty() || mesh.vertex_colors.size() == mesh.positions.size());
  for (std::uint32_t index : mesh.triangles) demand(index < mesh.positions.size());
  for (const glm::dvec3& p : mesh.positions)
    demand(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  for (const glm::vec2& uv : mesh.corner_uvs) demand(std::isfinite(uv.x) && std::isfinite(uv.y));
  demand(mesh.triangle_materials.empty() ? mesh.materials.empty()
                                         : mesh.triangle_materials.size() == mesh.triangle_count());
  for (std::uint16_t material : mesh.triangle_materials)
    demand(material == mesh::kNoMaterial || material < mesh.materials.size());
  for (const mesh::Material& material : mesh.materials)
    demand(material.texture == -1 ||
           static_cast<std::size_t>(material.texture) < mesh.textures.size());
  const ManifoldFaults faults = manifold_faults(mesh);
  demand(faults.crowded_edges == 0 && faults.disagreements == 0 && faults.vertices_of_fans == 0);
  demand(OpenMeshOracle(mesh).refused.empty());
}

}  // namespace strata::test
