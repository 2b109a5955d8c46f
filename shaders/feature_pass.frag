#version 450 core
#include "shared/features.h"
// Draws points, and lines with round ends. Light casings separate them from the surface, also in
// grayscale. All casings are drawn before the inner parts, so no segment of a line covers another.
// A pixel is drawn if the nearest tested point of the segment is shown.
layout(location = 0) in vec2 place;
layout(location = 1) flat in vec4 ends;
layout(location = 2) flat in float mark_half_width;
layout(location = 3) flat in vec4 mark_color;
layout(location = 4) flat in uvec2 places;  // number of tested points, and bits of the shown ones
layout(location = 0) out vec4 picture;

void main() {
  vec2 along = ends.zw - ends.xy;
  float squared = dot(along, along);
  float t = squared > 0.0 ? clamp(dot(place - ends.xy, along) / squared, 0.0, 1.0) : 0.0;
  uint nearest = min(uint(t * float(places.x)), places.x - 1u);
  float cover = clamp(mark_half_width + 0.5 - distance(place, ends.xy + t * along), 0.0, 1.0);
  if (cover == 0.0 || (places.y >> nearest & 1u) == 0u) discard;
  picture = vec4(mark_color.rgb, cover * mark_color.a);
}
