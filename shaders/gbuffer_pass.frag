#version 450 core
#include "shared/mesh.h"
#include "shared/museum_light.h"
// Outputs the texture coordinate and the lit base color. The texture coordinate has 16 bits per
// axis: floor(uv * 65536), which maps exactly to texels of a power-of-two resolution. The alpha is
// the light, which shade_pass applies to the layers. HEADLIGHT, RAKING_LIGHT or UNLIT replace the
// museum light. EXPOSED makes the colors brighter or darker. LOOKS is the number of surface images
// over the vertex colors.
layout(location = 0) in vec2 surface_uv;
#ifndef LIT_VERTICES
layout(location = 1) in vec4 surface_normal;
#endif
layout(location = 2) in vec4 surface_color;
layout(std140, binding = 0) uniform MeshBlock { MeshUniforms mesh; };

#if LOOKS > 0
layout(binding = 0) uniform sampler2D looks[LOOKS];  // sRGB codes, like all colors in this shader
#endif

layout(location = 0) out uint packed_uv;
layout(location = 1) out vec4 lit;

float light_here() {
#if defined(LIT_VERTICES)
  return surface_color.a;
#elif defined(HEADLIGHT)
  return 0.1 + 0.9 * clamp(abs(surface_normal.w) / length(surface_normal.xyz), 0.0, 1.0);
#elif defined(UNLIT)
  return 1.0;
#else
  vec3 n = normalize(surface_normal.xyz);
  if (is_seen_from_behind(surface_normal.w)) n = -n;
#if defined(RAKING_LIGHT)
  float fill = mesh.fill_light.w;
  float from_eye = 0.5 * abs(surface_normal.w);
  float from_side = mesh.key_light.w * max(0.0, dot(n, mesh.key_light.xyz));
  return min(0.04 + mix(from_side, from_eye, fill), 1.0);
#else
  return museum_light(n, surface_color.a, mesh);
#endif
#endif
}

void main() {
  // The limit 65534 in y ensures that the result is never kBackground. The numbers are signed,
  // because processors convert signed numbers in one step.
  ivec2 q = ivec2(clamp(surface_uv * 65536.0, vec2(0.0), vec2(65535.0, 65534.0)));
  packed_uv = uint(q.x | q.y << 16);

  vec3 color = surface_color.rgb;
#if LOOKS > 0
  for (int i = 0; i < LOOKS; ++i) {
    vec4 look = texture(looks[i], surface_uv);
    color = mix(color, look.rgb, look.a * mesh.look_opacity[i]);
  }
#endif
  float light = light_here();
  color *= light;
#ifdef EXPOSED  // without exposure, no color is too bright
  color = tone_mapped(color * mesh.rim_light.w);
#endif
  lit = vec4(color, light);  // the format clamps to 1
#ifdef SECTION
  bool inside = !gl_FrontFacing && mesh.eye_is_cut_away != 0u;
  gl_FragDepth = marked_depth(gl_FragCoord.z, inside);
  if (inside) {
    packed_uv = kBackground;  // layers do not cover the inside of a solid
    lit = vec4(1.0);  // shade_pass colors the inside
  }
#endif
}
