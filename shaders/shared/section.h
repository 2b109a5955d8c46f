#pragma once
#include "shared/types.h"
// Section planes in model space, of unit length: a point is kept where dot(plane.xyz, p) + plane.w is not below 0 for any.
// A cut through a solid is closed: where the back of its surface is seen from an eye that is cut away, the eye looks at the
// solid's inside.
STRATA_SHARED_BEGIN
const uint kSectionPlanes = 6u;  // ones that are not used keep everything
// Lowest bit of a depth of a cut model: set where a solid's inside is seen. Nothing is painted there.
const uint kInsideMark = 1u;
STRATA_SHARED_END
#ifndef __cplusplus
float marked_depth(float depth, bool inside) {
  return uintBitsToFloat((floatBitsToUint(depth) & ~kInsideMark) | (inside ? kInsideMark : 0u));
}
#endif
