#version 450 core
#include "shared/features.h"
#include "shared/section.h"
// Tests which points of marks are visible. A symbol is drawn completely if its point is visible,
// even if the surface around the point would hide a part of it. A point is visible if its depth
// below the visible surface, measured perpendicular to that surface, is at most its reach. Two
// dispatches are necessary: CLOSE_GAPS 0 tests the points, CLOSE_GAPS 1 closes short gaps in lines.
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer SegmentBlock { FeatureSegment segments[]; };
layout(location = 0) uniform uint segment_count;
#if CLOSE_GAPS == 0
layout(binding = 0) uniform sampler2D depth;
layout(location = 1) uniform uint flags;

float depth_at(ivec2 pixel) { return texelFetch(depth, clamp(pixel, ivec2(0), textureSize(depth, 0) - 1), 0).r; }

bool is_visible(vec3 place, float pixel_depth, float reach_px) {
  ivec2 pixel = ivec2(floor(place.xy));
  float here = depth_at(pixel);
  if ((flags & kFeatureCutOpen) != 0u && (floatBitsToUint(here) & kInsideMark) != 0u) return false;
  float left = depth_at(pixel - ivec2(1, 0)), right = depth_at(pixel + ivec2(1, 0));
  float below = depth_at(pixel - ivec2(0, 1)), above = depth_at(pixel + ivec2(0, 1));
  // Uses the smaller difference of each axis, because the other one may cross an edge.
  vec2 slope = vec2(min(abs(left - here), abs(right - here)), min(abs(below - here), abs(above - here)));
  float steep = min(length(slope), kFeatureSteepest * pixel_depth);
  // The point may be anywhere in its pixel.
  float farthest = max(here, max(max(left, right), max(below, above)));
  return place.z <= farthest + reach_px * length(vec2(pixel_depth, steep));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= segment_count) return;
  FeatureSegment segment = segments[i];
  uint seen = 0u;
  for (uint k = 0u; k < segment.place_count; ++k) {
    float t = (float(k) + 0.5) / float(segment.place_count);
    vec3 place = mix(segment.from.xyz, segment.to.xyz, t);
    if (is_visible(place, mix(segment.reach.x, segment.reach.y, t), mix(segment.reach.z, segment.reach.w, t))) seen |= 1u << k;
  }
  segments[i].seen = seen;
}
#else
// Returns the number of steps to the next visible point. Returns more than kFeatureClosedPlaces if
// that point is too far or the line ends before it.
uint steps_to_seen(uint i, uint place, bool back) {
  for (uint step = 1u; step <= kFeatureClosedPlaces; ++step) {
    if (back && place == 0u) {
      if ((segments[i].joins & kFeatureJoinsLast) == 0u) break;
      --i;
      place = segments[i].place_count;
    } else if (!back && place + 1u == segments[i].place_count) {
      if ((segments[i].joins & kFeatureJoinsNext) == 0u) break;
      ++i;
      place = 0u;
      if ((segments[i].seen & 1u) != 0u) return step;
      continue;
    }
    place = back ? place - 1u : place + 1u;
    if ((segments[i].seen >> place & 1u) != 0u) return step;
  }
  return kFeatureClosedPlaces + 1u;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= segment_count) return;
  uint shown = segments[i].seen;
  for (uint k = 0u; k < segments[i].place_count; ++k) {
    if ((shown >> k & 1u) != 0u) continue;
    if (steps_to_seen(i, k, true) + steps_to_seen(i, k, false) <= kFeatureClosedPlaces + 1u) shown |= 1u << k;
  }
  segments[i].shown = shown;
}
#endif
