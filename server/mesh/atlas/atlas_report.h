#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// The numbers of texels of an atlas that have owners at one resolution. Triangles are rasterized as
// in OpenGL.
struct TexelCounts {
  std::uint64_t covered = 0;
  std::uint64_t shared = 0;  // covered by more than one triangle
  // triangles that cover a texel already covered by an earlier triangle
  std::vector<std::uint32_t> shared_by;
};

// The area distortion of an atlas.
struct AtlasMeasure {
  double area = 0;                           // of the surface, unit²
  double area_without_uv = 0;                // of triangles with a UV area of 0, in unit²
  double uv_area = 0;                        // of the triangles, as a share of the atlas
  double stretch_mean = 0, stretch_p99 = 0;  // as in AtlasReport, at most 50 per triangle
};

// In all functions of this file, `corner_uvs` must be in [0,1]².
TexelCounts count_owners(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs,
                         int resolution);
AtlasMeasure measure_areas(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs);

// Returns the largest surface area in one texel, in unit². Triangles are clipped against the
// texels.
double largest_texel_area(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs,
                          int resolution);

// Makes the report from the results at `lowest_resolution`, except for `source` and `charts`. Texel
// sizes are measured at that resolution, twice that resolution and four times that resolution, on
// two threads.
AtlasReport make_report(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs,
                        int lowest_resolution, const TexelCounts& owners,
                        const AtlasMeasure& measure);

}  // namespace strata::mesh
