#pragma once

#include "core/progress.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Texture coordinates for every corner, and what can be said of them.
struct Atlas {
  std::vector<glm::vec2> corner_uvs;  // 3 a triangle, inside [0,1]²
  AtlasReport report;
  // Of the file's own coordinates: triangles that could not stay where the file has them
  // (ascending), what all others were multiplied with to make room for these, and both in words.
  std::vector<std::uint32_t> moved = {};
  float kept_scale = 1;
  std::vector<Repair> repairs = {};
};

// The file's own UVs, where they can carry layers: inside one tile, every triangle with area has uv
// area (up to 0.1 % of the surface may not), and at least 99.5 % of covered texels at
// `lowest_resolution` have one owner (the rest is reported as `overlap`). Triangles that break this
// are moved to free texels, where they are at most 10 % of the surface. Otherwise an error that
// says why, and the caller makes an atlas.
Result<Atlas> keep_uvs(const TriangleMesh& mesh, int lowest_resolution, Progress& progress);

// Our own unwrap: cone-bounded charts grown on a smoothed copy and flattened so that no triangle is
// folded and few are squeezed, each at the scale of its surface, packed by their exact texels with
// ≥ 2 texels between them at `lowest_resolution`. Connected faces of one plane are one chart. Where
// less than 60 % of the texels would be used, charts as long as the atlas are squeezed, hollow ones
// of larger meshes cut, and the gaps made narrow; where it stays less, the report's limits say why.
// It is verified at final density (conflicting faces are moved to charts of their own). Two
// threads; the result does not depend on their number.
Result<Atlas> make_atlas(const TriangleMesh& mesh, int lowest_resolution, Progress& progress);

}  // namespace strata::mesh
