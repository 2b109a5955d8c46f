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
  // scale of the coordinates that stay, less than 1 where the texture had no free room
  float scale = 1;
};

// Unfolds the triangles `moved` (ascending, each with area) and places them, at the scale of the
// rest, on texels that the rest leaves free at `resolution`; without enough room, at a smaller
// scale; and then next to the rest, which is made smaller. `corner_uvs` of the rest lie in [0,1]².
// Empty where nothing fits, or when cancelled.
std::optional<MovedUvs> move_triangles(const TriangleMesh& mesh,
                                       std::span<const glm::vec2> corner_uvs,
                                       std::span<const std::uint32_t> moved, int resolution,
                                       Progress& progress);

}  // namespace strata::mesh
