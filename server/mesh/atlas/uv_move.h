#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

struct MovedUvs {
  std::vector<glm::vec2> corner_uvs;
  // scale of the coordinates that stay; less than 1 if the texture had no free space
  float scale = 1;
};

// Unfolds the triangles `moved`, which are ascending and have an area. Places them on texels that
// the other triangles leave free at `resolution`, at the scale of the other triangles. If there is
// not enough room, uses a smaller scale for the moved triangles. If this is not enough, also scales
// the other triangles down. `corner_uvs` of the other triangles are in [0,1]². Returns nothing if
// the work is canceled, or if the triangles do not fit at any scale.
std::optional<MovedUvs> move_triangles(const TriangleMesh& mesh,
                                       std::span<const glm::vec2> corner_uvs,
                                       std::span<const std::uint32_t> moved, int resolution,
                                       Progress& progress);

}  // namespace strata::mesh
