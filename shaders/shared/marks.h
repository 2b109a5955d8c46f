#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
// A line, or a point where both ends are one, on the plane of a picture: pixels from its lower left corner, depth 0…1.
struct MarkSegment {
  vec4 from;  // x, y, depth, half of its width
  vec4 to;    // x, y, depth, width of its casing
  vec4 color;
};
struct MarkUniforms {
  vec4 size;  // of the picture: width, height; z is 0 where casings are drawn, 1 where what is in them is
};
STRATA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(strata::shader::MarkSegment) == 48);
#endif
