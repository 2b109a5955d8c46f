#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// How many triangles own the texels of an atlas at one resolution, rasterized as by OpenGL.
struct TexelCounts {
  std::uint64_t covered = 0;
  std::uint64_t shared = 0;  // covered by more than one triangle
  // triangles that cover a texel which an earlier triangle covers
  std::vector<std::uint32_t> shared_by;
};

// How an atlas changes areas.
struct AtlasMeasure {
  double area = 0;                           // of the surface, unit²
  double area_without_uv = 0;                // of triangles whose uv area is 0, unit²
  double uv_area = 0;                        // of the triangles, share of the atlas
  double stretch_mean = 0, stretch_p99 = 0;  // as in AtlasReport; a triangle counts at most 50
};

// In all functions here `corner_uvs` must lie in [0,1]².
TexelCounts count_owners(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs,
                         int resolution);
AtlasMeasure measure_areas(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs);

// Returns the largest area of surface in one texel, unit²: triangles are clipped against the
// texels.
double largest_texel_area(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs,
                          int resolution);

// Makes all of the report but `source` and `charts`, from the results at `lowest_resolution`. Texel
// sizes are measured there and at twice and four times that, on two threads.
AtlasReport make_report(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs,
                        int lowest_resolution, const TexelCounts& owners,
                        const AtlasMeasure& measure);

}  // namespace strata::mesh
