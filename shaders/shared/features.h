#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
// Places of a segment whose visibility is decided, one bit each.
const uint kFeatureMaxPlaces = 32u;
const float kFeatureStep_px = 2.0;      // between two places of a line, pixels of the camera's window
const uint kFeatureClosedPlaces = 3u;   // hidden places between visible ones that a line is drawn over
const float kFeatureSteepest = 12.0;    // slope of the surface to the picture's plane that the reach still follows
const uint kFeatureJoinsLast = 1u;      // the segment continues the line of the one before it in the buffer
const uint kFeatureJoinsNext = 2u;      // the one after it continues the line
const uint kFeatureCutOpen = 1u;        // of FeatureSightUniforms: depths carry marks of a solid's inside (shared/section.h)

// A piece of a line, or a point where both ends are one, on the plane of a picture: pixels from its lower left corner, depth 0…1.
struct FeatureSegment {
  vec4 from;   // x, y, depth, half of its width
  vec4 to;     // x, y, depth, width of its casing
  vec4 color;
  // Of its ends: by how much depth grows over the length of one pixel there, and how far below the surface that is seen a place
  // may lie and still be visible, in pixels.
  vec4 reach;  // depth at from, depth at to, pixels at from, pixels at to
  uint place_count;  // 1…kFeatureMaxPlaces, spread evenly over it
  uint joins;
  uint seen;   // a bit for each place that the surface does not hide
  uint shown;  // the same with short gaps closed: what is drawn
};
struct FeatureUniforms {
  vec4 size;  // of the picture: width, height; z is 0 where casings are drawn, 1 where what is in them is
};
STRATA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(strata::shader::FeatureSegment) == 80);
#endif
