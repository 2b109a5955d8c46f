#pragma once
#include "shared/types.h"
// The inside of a solid that a section cuts open. It is drawn like the profile of a sherd: hatched
// at 45 degrees with an outline. Sizes are in pixels of the camera's window.
STRATA_SHARED_BEGIN
const float kCutHatchPixels = 9.0;  // distance between two lines
const float kCutLinePixels = 1.25;
const float kCutOutlinePixels = 2.0;
STRATA_SHARED_END
#ifndef __cplusplus
const vec3 kCutGround = vec3(0.86, 0.82, 0.76);
const vec3 kCutInk = vec3(0.24, 0.19, 0.16);

// Returns the share of a pixel that the hatch covers. `from` is the distance from the origin of
// patterns in pixels. `scale` is the number of frame pixels per pixel of the camera's window.
float cut_hatch(vec2 from, float scale) {
  float across = (from.x - from.y) * 0.70710678 / (kCutHatchPixels * scale);
  // The distance from the middle of the line.
  float middle = abs(across - floor(across) - 0.5) * kCutHatchPixels;
  return clamp((0.5 * kCutLinePixels - middle) * scale + 0.5, 0.0, 1.0);
}
#endif
