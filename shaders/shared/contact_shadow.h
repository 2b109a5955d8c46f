#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
const float kContactShadowStrength = 0.42;  // share of background light that full cover removes

struct ContactShadowUniforms {
  // Rows of the matrix from a pixel (x, y from the lower left corner, 1) to the map: x and y of the
  // result, divided by z, are 0…1 inside the map. z is positive in front of the eye.
  vec4 map_from_pixel[3];
};
STRATA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(strata::shader::ContactShadowUniforms) == 48);
#endif
