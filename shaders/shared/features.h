#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
// Places of a segment whose visibility is tested, one bit each.
const uint kFeatureMaxPlaces = 32u;
const float kFeatureStep_px = 2.0;      // between two places of a line, pixels of the camera's window
const uint kFeatureClosedPlaces = 3u;   // hidden places between visible ones that are drawn anyway
const float kFeatureSteepest = 12.0;    // largest slope to the picture plane that the reach follows
const uint kFeatureJoinsLast = 1u;      // the segment continues that before it in the buffer
const uint kFeatureJoinsNext = 2u;      // the segment after it continues the line
const uint kFeatureCutOpen = 1u;        // depths contain marks of insides (shared/section.h)

// A piece of a line, or a point if both ends are equal, on the plane of a picture: pixels from its
// lower left corner, depth 0…1.
struct FeatureSegment {
  vec4 from;   // x, y, depth, half of its width
  vec4 to;     // x, y, depth, width of its casing
  vec4 color;
  // At both ends: the change of depth over the length of one pixel, and how far below the visible
  // surface a place may be and still be visible, in pixels.
  vec4 reach;  // depth at from, depth at to, pixels at from, pixels at to
  uint place_count;  // 1…kFeatureMaxPlaces, spread evenly over it
  uint joins;
  uint seen;   // a bit for each place that the surface does not hide
  uint shown;  // the same with short gaps closed: the drawn places
};
struct FeatureUniforms {
  // of the picture: width, height; z is 0 when casings are drawn, 1 when the inner parts are
  vec4 size;
};
STRATA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(strata::shader::FeatureSegment) == 80);
#endif
