#pragma once
#include "shared/types.h"
// The inside of a solid that a section cuts open, drawn as the profile of a sherd is: hatched at
// 45 degrees with an outline. Sizes are pixels of the camera's window.
STRATA_SHARED_BEGIN
const float kCutHatchPixels = 9.0;  // between two lines
const float kCutLinePixels = 1.25;
const float kCutOutlinePixels = 2.0;
STRATA_SHARED_END
#ifndef __cplusplus
const vec3 kCutGround = vec3(0.86, 0.82, 0.76);
const vec3 kCutInk = vec3(0.24, 0.19, 0.16);

// `from`: pixels from the origin of patterns; `scale`: pixels for one of the camera's.
float cut_hatch(vec2 from, float scale) {
  float across = (from.x - from.y) * 0.70710678 / (kCutHatchPixels * scale);
  float middle = abs(across - floor(across) - 0.5) * kCutHatchPixels;  // from the line's middle
  return clamp((0.5 * kCutLinePixels - middle) * scale + 0.5, 0.0, 1.0);
}
#endif
