#version 450 core
// Lines with round ends and points, in a light casing that parts them from what lies below, also in greys.
layout(location = 0) in vec2 place;
layout(location = 1) flat in vec4 ends;
layout(location = 2) flat in vec2 widths;  // half of the mark's, the casing's
layout(location = 3) flat in vec4 mark_color;
layout(location = 0) out vec4 picture;

const vec3 kCasing = vec3(1.0);

float distance_to_segment(vec2 p, vec2 a, vec2 b) {
  vec2 along = b - a;
  float squared = dot(along, along);
  float t = squared > 0.0 ? clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
  return distance(p, a + t * along);
}

void main() {
  float from_middle = distance_to_segment(place, ends.xy, ends.zw);
  float cover = clamp(widths.x + widths.y + 0.5 - from_middle, 0.0, 1.0);
  if (cover == 0.0) discard;
  float core = clamp(widths.x + 0.5 - from_middle, 0.0, 1.0);
  picture = vec4(mix(kCasing, mark_color.rgb, core), cover * mark_color.a);
}
