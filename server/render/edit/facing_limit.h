#pragma once

#include <glm/glm.hpp>

#include "domain/scene/camera.h"

namespace strata::render {

// The largest viewing angle of a paintable surface, prepared for the tests of texels. The normal
// belongs to the plane through the depths of the pixel and its neighbors. This normal needs no
// memory in addition to the 8 bytes of a texel's position, and it is the same on all machines. It
// is as smooth as the visible surface, so scan noise smaller than a pixel has no effect. A plane's
// depth is linear in the window, also with perspective. Therefore a plane's angle is exact except
// for rounding.
//
// Let x, y, z, w be the rows of clip_from_model, (u, v) a pixel's center in clip space, and d its
// depth in the window. The planes a = x - u w and b = y - v w contain the pixel's ray, so the ray's
// direction is a × b. A plane whose depth changes by s and t per pixel has the normal s · width · a
// + t · height · b + (w - z) - 2 (1 - d) w. `far_row` is w - z, computed in double, because w and z
// nearly cancel.
struct FacingLimit {
  glm::vec3 x_row, y_row, w_row, far_row;
  float least_squared_cosine = 0;
};
FacingLimit make_facing_limit(const Camera& camera, double max_angle_deg);

}  // namespace strata::render
