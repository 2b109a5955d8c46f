#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace strata::mesh {

// Whom the texels of an atlas belong to at one resolution, found by rasterising it as OpenGL does.
struct TexelOwners {
  std::uint64_t covered = 0;
  std::uint64_t shared = 0;              // covered by more than one triangle
  std::vector<std::uint32_t> shared_by;  // triangles that cover a texel which one before them covers
};

// What an atlas does to areas at one resolution.
struct AtlasMeasure {
  double area = 0;                           // of the surface, unit²
  double area_without_uv = 0;                // of triangles whose uv area is 0, unit²
  double stretch_mean = 0, stretch_p99 = 0;  // as in AtlasReport; a triangle counts at most 50
  double texel_area_max = 0;                 // unit²
};

// `corner_uvs` must lie in [0,1]².
TexelOwners count_owners(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs, int resolution);
AtlasMeasure measure_areas(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs, int resolution);

AtlasReport to_report(const TexelOwners& owners, const AtlasMeasure& measure, int resolution);

}  // namespace strata::mesh
