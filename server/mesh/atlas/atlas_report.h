#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Whom the texels of an atlas belong to at one resolution, found by rasterising it as OpenGL does.
struct TexelCounts {
  std::uint64_t covered = 0;
  std::uint64_t shared = 0;  // covered by more than one triangle
  // triangles that cover a texel which one before them covers
  std::vector<std::uint32_t> shared_by;
};

// What an atlas does to areas.
struct AtlasMeasure {
  double area = 0;                           // of the surface, unit²
  double area_without_uv = 0;                // of triangles whose uv area is 0, unit²
  double uv_area = 0;                        // of the triangles, share of the atlas
  double stretch_mean = 0, stretch_p99 = 0;  // as in AtlasReport; a triangle counts at most 50
};

// `corner_uvs` must lie in [0,1]², everywhere here.
TexelCounts count_owners(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs,
                         int resolution);
AtlasMeasure measure_areas(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs);

// The surface that lies in the texel that holds most, unit²: triangles are clipped against the
// texels.
double largest_texel_area(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs,
                          int resolution);

// All of the report but `source` and `charts`, from what was found at `lowest_resolution`; texel
// sizes are measured there and at twice and four times that, on two threads.
AtlasReport make_report(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs,
                        int lowest_resolution, const TexelCounts& owners,
                        const AtlasMeasure& measure);

}  // namespace strata::mesh
