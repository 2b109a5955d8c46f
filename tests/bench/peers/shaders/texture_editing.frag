#version 450 core
layout(location = 0) in vec4 projected;
layout(location = 1) uniform vec2 window_size;
layout(location = 2) uniform vec2 center;   // in window pixels, origin lower left
layout(location = 3) uniform float radius;
layout(location = 4) uniform float bias;
layout(location = 5) uniform uint value;
layout(location = 6) uniform uint edit_number;
layout(binding = 0) uniform sampler2D depth;
layout(location = 0) out uint data;
layout(location = 1) out uint mask;
layout(location = 2) out uint edited;

void main() {
  if (projected.w <= 0.0 || abs(projected.z) > projected.w) discard;
  vec3 ndc = projected.xyz / projected.w;
  vec2 s = ndc.xy * 0.5 + 0.5;
  if (any(lessThan(s, vec2(0.0))) || any(greaterThanEqual(s, vec2(1.0)))) discard;
  // (a) depth test
  vec2 window = s * window_size;
  if (ndc.z * 0.5 + 0.5 - bias > texelFetch(depth, ivec2(window), 0).r) discard;
  // (b) projective texturing: the tool's square
  vec2 tool = (window - center) / (2.0 * radius) + 0.5;
  if (any(lessThan(tool, vec2(0.0))) || any(greaterThanEqual(tool, vec2(1.0)))) discard;
  // (c) shape masking
  vec2 d = window - center;
  if (dot(d, d) >= radius * radius) discard;
  data = value;
  mask = 1u;
  edited = edit_number;
}
