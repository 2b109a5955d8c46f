#pragma once
#include "shared/types.h"
// Section planes in model space, of unit length: a point is kept if dot(plane.xyz, p) + plane.w is
// not negative for any plane. Cut solids are closed: if the eye is in the part cut away, a visible
// back face shows the solid's inside.
STRATA_SHARED_BEGIN
const uint kSectionPlanes = 6u;  // unused ones keep everything
// Lowest bit of a depth of a cut model: set where a solid's inside is visible. Nothing is painted
// there.
const uint kInsideMark = 1u;
STRATA_SHARED_END
#ifndef __cplusplus
float marked_depth(float depth, bool inside) {
  return uintBitsToFloat((floatBitsToUint(depth) & ~kInsideMark) | (inside ? kInsideMark : 0u));
}
#endif
