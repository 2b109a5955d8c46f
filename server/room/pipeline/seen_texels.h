#pragma once

#include <map>

#include "domain/layers/tile.h"
#include "domain/scene/camera.h"
#include "mesh/texels/surface_map.h"
#include "render/renderer.h"

namespace strata::room {

using TileMasks = std::map<TileAddress, TileMask>;

// Returns the texels, including the gutter, that a camera sees inside a box of its window (pixels,
// origin top left). These are the texels that a stroke over the box would write, with the same
// tests of depth and section. `through` also includes hidden texels. Waits for the GPU, which must
// have the surface map of the resolution.
Result<TileMasks> seen_texels(render::Renderer& renderer, render::ModelHandle model, int resolution,
                              const Camera& camera, const glm::dvec2& low, const glm::dvec2& high,
                              bool through);

// Projects a position in model space (world minus `origin`) into the window of a camera, in pixels
// with the origin at the top left. Only for positions in front of the eye.
class WindowProjection {
 public:
  WindowProjection(const Camera& camera, const glm::dvec3& origin);
  glm::dvec2 operator()(const glm::vec3& position) const;

 private:
  glm::dmat4 clip_from_model_;
  glm::dvec2 half_window_;
};

}  // namespace strata::room
