#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
// The largest number of a segment's tested points, each with one bit.
const uint kFeatureMaxPlaces = 32u;
const float kFeatureStep_px = 2.0;      // between points of a line, pixels of the camera's window
const uint kFeatureClosedPlaces = 3u;   // longest gap of hidden points that is drawn
const float kFeatureSteepest = 12.0;    // largest slope to the image plane that extends the reach
const uint kFeatureJoinsLast = 1u;      // the segment continues the previous one in the buffer
const uint kFeatureJoinsNext = 2u;      // the next segment in the buffer continues the line
const uint kFeatureCutOpen = 1u;        // depths mark the inside of solids (shared/section.h)

// A piece of a line on the image plane, or a point if both ends are equal. Coordinates are pixels
// from the lower left corner and a depth 0…1.
struct FeatureSegment {
  vec4 from;   // x, y, depth, half of the line's width
  vec4 to;     // x, y, depth, width of the casing
  vec4 color;
  // At both ends: the change of depth over the length of one pixel, and the largest distance of a
  // visible point below the visible surface, in pixels.
  vec4 reach;  // depth at from, depth at to, pixels at from, pixels at to
  uint place_count;  // number of tested points, 1…kFeatureMaxPlaces, at equal distances
  uint joins;
  uint seen;   // one bit for each point that the surface does not hide
  uint shown;  // the drawn points: `seen` with short gaps closed
};
struct FeatureUniforms {
  // x, y: width and height of the frame; z: 0 for the draw of casings, 1 for the inner parts
  vec4 size;
};
STRATA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(strata::shader::FeatureSegment) == 80);
#endif
