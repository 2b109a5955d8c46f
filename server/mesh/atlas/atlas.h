#pragma once

#include "core/progress.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// The texture coordinates of every corner and the report on them.
struct Atlas {
  std::vector<glm::vec2> corner_uvs;  // 3 per triangle, inside [0,1]²
  AtlasReport report;
  // These members are for the file's own coordinates. `moved` lists the triangles that could not
  // keep the coordinates of the file (ascending). `kept_scale` is the factor by which all other
  // triangles were scaled to make room for them. `repairs` describes both changes in words.
  std::vector<std::uint32_t> moved = {};
  float kept_scale = 1;
  std::vector<Repair> repairs = {};
};

// Keeps the file's own UVs if they are suitable for layers. All UVs must be inside one tile. Every
// triangle with area must have an area in UV space, except for up to 0.1 % of the surface. At least
// 99.5 % of the covered texels at `lowest_resolution` must have one owner. The others are reported
// as `overlap`. Triangles that violate these rules are moved to free texels if they make up at most
// 10 % of the surface. Otherwise returns an error with the reason, and the caller makes an atlas.
Result<Atlas> keep_uvs(const TriangleMesh& mesh, int lowest_resolution, Progress& progress);

// Unwraps the surface into charts bounded by a cone of normals. Grows the charts on a smoothed copy
// of the mesh. Flattens them so that no triangle is folded and only a few are compressed. Each
// chart has the scale of its surface. Charts are packed by their exact texels with at least 2
// texels between them at `lowest_resolution`. Connected faces of one plane form one chart. If less
// than 60 % of the texels would be used, charts as long as the atlas are squeezed. Hollow charts of
// larger meshes are cut, and the gaps are narrowed. If the coverage stays lower, the report's
// limits give the reasons. The result is verified at the final density, and conflicting faces get
// their own charts. Uses two threads. The result does not depend on the number of threads.
Result<Atlas> make_atlas(const TriangleMesh& mesh, int lowest_resolution, Progress& progress);

}  // namespace strata::mesh
