#pragma once

#include <glm/glm.hpp>

#include "domain/scene/camera.h"

namespace strata::render {

// The limit of the angle at which a surface is seen, as the tests of texels need it. The normal is
// that of the plane through what the pixel and its neighbours show: no memory for normals beside
// the 8 bytes of a texel's position, the same on every machine, and as smooth as what the person
// sees, so that the noise of a scan that is smaller than a pixel does not decide. In a window the
// depth of a plane is linear, also with perspective, so a plane's angle is exact but for rounding.
//
// With the rows x, y, z, w of clip_from_model, a pixel's centre (u, v) in clip space, and its depth
// d in the window: the sides a = x - u w and b = y - v w of the pixel hold its ray, so the ray's
// direction is a × b; a plane whose depth changes by s and t a pixel has the normal s · width · a +
// t · height · b + (w - z) - 2 (1 - d) w. `far_row` is w - z, made in double, because the two
// nearly cancel.
struct FacingLimit {
  glm::vec3 x_row, y_row, w_row, far_row;
  float least_squared_cosine = 0;
};
FacingLimit make_facing_limit(const Camera& camera, double max_angle_deg);

}  // namespace strata::render
