#pragma once

#include "core/progress.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Texture coordinates of every corner, and the report on them.
struct Atlas {
  std::vector<glm::vec2> corner_uvs;  // 3 a triangle, inside [0,1]²
  AtlasReport report;
  // For the file's own coordinates: triangles that could not stay at their coordinates in the file
  // (ascending), the factor by which all others were scaled to make room for these, and both in
  // words.
  std::vector<std::uint32_t> moved = {};
  float kept_scale = 1;
  std::vector<Repair> repairs = {};
};

// Keeps the file's own UVs, where they can carry layers: inside one tile, every triangle with area
// has uv area (except up to 0.1 % of the surface), and at least 99.5 % of covered texels at
// `lowest_resolution` have one owner (the rest is reported as `overlap`). Triangles that violate
// this are moved to free texels, where they are at most 10 % of the surface. Otherwise returns an
// error with the reason, and the caller makes an atlas.
Result<Atlas> keep_uvs(const TriangleMesh& mesh, int lowest_resolution, Progress& progress);

// Unwraps the surface: cone-bounded charts, grown on a smoothed copy and flattened so that no
// triangle is folded and few are squeezed, each at the scale of its surface, packed by their exact
// texels with ≥ 2 texels between them at `lowest_resolution`. Connected faces of one plane are one
// chart. Where less than 60 % of the texels would be used, charts as long as the atlas are
// squeezed, hollow ones of larger meshes cut, and the gaps made narrow; where the coverage stays
// lower, the report's limits give the reasons. The result is verified at the final density:
// conflicting faces get their own charts. Uses two threads; the result does not depend on their
// number.
Result<Atlas> make_atlas(const TriangleMesh& mesh, int lowest_resolution, Progress& progress);

}  // namespace strata::mesh
