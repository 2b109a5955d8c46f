#version 450 core
// Lines with round ends and points. Light casings part them from what lies below, also in greys; all of them are drawn before what is in
// them, so that segments of a line do not cut each other.
layout(location = 0) in vec2 place;
layout(location = 1) flat in vec4 ends;
layout(location = 2) flat in float mark_half_width;
layout(location = 3) flat in vec4 mark_color;
layout(location = 0) out vec4 picture;

float distance_to_segment(vec2 p, vec2 a, vec2 b) {
  vec2 along = b - a;
  float squared = dot(along, along);
  float t = squared > 0.0 ? clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
  return distance(p, a + t * along);
}

void main() {
  float cover = clamp(mark_half_width + 0.5 - distance_to_segment(place, ends.xy, ends.zw), 0.0, 1.0);
  if (cover == 0.0) discard;
  picture = vec4(mark_color.rgb, cover * mark_color.a);
}
