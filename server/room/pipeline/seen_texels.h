#pragma once

#include <map>

#include "domain/layers/tile.h"
#include "domain/scene/camera.h"
#include "mesh/texels/surface_map.h"
#include "render/renderer.h"

namespace strata::room {

using TileMasks = std::map<TileAddress, TileMask>;

// Returns the texels, including the gutter, whose surface positions a camera sees inside a box of
// its window (pixels, origin top left): those that a stroke over the box would write, with the same
// tests of depth and section. `through`: hidden ones, too. Waits for the GPU, which must have the
// surface map of the resolution.
Result<TileMasks> seen_texels(render::Renderer& renderer, render::ModelHandle model, int resolution,
                              const Camera& camera, const glm::dvec2& low, const glm::dvec2& high,
                              bool through);

// Projects a place in model space (world minus `origin`) into a camera's window, in pixels with the
// origin top left. Only for places in front of the eye.
class WindowProjection {
 public:
  WindowProjection(const Camera& camera, const glm::dvec3& origin);
  glm::dvec2 operator()(const glm::vec3& position) const;

 private:
  glm::dmat4 clip_from_model_;
  glm::dvec2 half_window_;
};

}  // namespace strata::room
