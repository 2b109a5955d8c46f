#pragma once

#include <glm/glm.hpp>

#include "domain/scene/camera.h"

namespace strata::render {

// The limit of the angle at which a surface is seen, in the form for the tests of texels. The
// normal is that of the plane through the depths of the pixel and its neighbors: this needs no
// memory for normals in addition to the 8 bytes of a texel's position, is the same on every
// machine, and is as smooth as the visible surface, so that scan noise smaller than a pixel has no
// effect. Depth is linear in the window for a plane, also with perspective, so a plane's angle is
// exact except for rounding.
//
// With the rows x, y, z, w of clip_from_model, a pixel's center (u, v) in clip space, and its depth
// d in the window: the sides a = x - u w and b = y - v w of the pixel contain its ray, so the ray's
// direction is a × b; a plane whose depth changes by s and t a pixel has the normal s · width · a +
// t · height · b + (w - z) - 2 (1 - d) w. `far_row` is w - z, computed in double, because the two
// nearly cancel.
struct FacingLimit {
  glm::vec3 x_row, y_row, w_row, far_row;
  float least_squared_cosine = 0;
};
FacingLimit make_facing_limit(const Camera& camera, double max_angle_deg);

}  // namespace strata::render
