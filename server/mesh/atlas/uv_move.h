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
  // of the coordinates that stay, where the texture had no free room and was given some
  float scale = 1;
};

// Unfolds the triangles `moved` (ascending, each with surface) and lays them, at the scale that the
// rest has, on texels that the rest leaves free at `resolution`; where there is no room, at a
// smaller scale, and then beside the rest, which is made smaller. `corner_uvs` of the rest lie in
// [0,1]². Empty where nothing helps, or when cancelled.
std::optional<MovedUvs> move_triangles(const TriangleMesh& mesh,
                                       std::span<const glm::vec2> corner_uvs,
                                       std::span<const std::uint32_t> moved, int resolution,
                                       Progress& progress);

}  // namespace strata::mesh
