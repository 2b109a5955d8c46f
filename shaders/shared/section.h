#pragma once
#include "shared/types.h"
// Section planes in model space, with unit normals. A point is kept if dot(plane.xyz, p) + plane.w
// is at least 0 for all planes. Cut solids are closed. If the eye is in the removed part, visible
// back faces show the inside of the solid.
STRATA_SHARED_BEGIN
const uint kSectionPlanes = 6u;  // unused planes keep all points
// The lowest bit of a depth of a cut model. It is set at pixels that show the inside of a solid.
// Strokes do not paint there.
const uint kInsideMark = 1u;
STRATA_SHARED_END
#ifndef __cplusplus
float marked_depth(float depth, bool inside) {
  return uintBitsToFloat((floatBitsToUint(depth) & ~kInsideMark) | (inside ? kInsideMark : 0u));
}
#endif
