#version 450 core
#include "shared/mesh.h"
// Texture coordinate (16 bits each, floor of uv * 65536, so that a power of two of texels finds its texel exactly) and lit
// base colour with the light itself in alpha, by which layers are lit later. HEADLIGHT,
// RAKING_LIGHT or UNLIT take the place of the museum light; LOOKS is how many pictures lie over the colours of the vertices.
layout(location = 0) in vec2 surface_uv;
layout(location = 1) in vec4 surface_normal;
layout(location = 2) in vec3 surface_color;
#ifdef SECTION
const vec3 kInsideColor = vec3(0.47, 0.36, 0.31);
#endif
layout(std140, binding = 0) uniform MeshBlock { MeshUniforms mesh; };

#if LOOKS > 0
layout(binding = 0) uniform sampler2D looks[LOOKS];  // sRGB codes, as all colours here are
#endif

layout(location = 0) out uint packed_uv;
layout(location = 1) out vec4 lit;

// Two-sided: scans are open and their windings are not always right. Smooth normals lean away at silhouettes without the
// surface being seen from behind, so only those that clearly do are turned.
vec3 normal_towards_eye() {
  vec3 n = normalize(surface_normal.xyz);
  return surface_normal.w < -0.3 ? -n : n;
}

float light_on(vec3 n) {
#if defined(HEADLIGHT)
  return 0.1 + 0.9 * clamp(abs(surface_normal.w) / length(surface_normal.xyz), 0.0, 1.0);
#elif defined(RAKING_LIGHT)
  return min(0.04 + mesh.key_light.w * max(0.0, dot(n, mesh.key_light.xyz)), 1.0);
#elif defined(UNLIT)
  return 1.0;
#else
  // Museum light: a soft key from the upper left, a weak fill from the camera's right, and a sky that is brighter above.
  float key = dot(n, mesh.key_light.xyz);
  float wrapped = max(0.0, key * 0.8 + 0.2);
  float fill = max(0.0, dot(n, mesh.fill_light.xyz));
  float sky = 0.5 + 0.5 * dot(n, mesh.up.xyz);
  return min(0.22 + 0.18 * sky + 0.56 * wrapped * wrapped + 0.16 * fill, 1.0);
#endif
}

void main() {
  uvec2 q = uvec2(clamp(surface_uv, 0.0, 1.0) * 65536.0);
  packed_uv = min(q.x, 65535u) | (min(q.y, 65534u) << 16);  // never kBackground

  vec3 color = surface_color;
#if LOOKS > 0
  for (int i = 0; i < LOOKS; ++i) {
    vec4 look = texture(looks[i], surface_uv);
    color = mix(color, look.rgb, look.a * mesh.look_opacity[i]);
  }
#endif
  float light = light_on(normal_towards_eye());
  lit = vec4(color * light, light);
#ifdef SECTION
  bool inside = !gl_FrontFacing && mesh.eye_is_cut_away != 0u;
  gl_FragDepth = marked_depth(gl_FragCoord.z, inside);
  if (inside) {
    packed_uv = kBackground;  // nothing is painted there
    lit = vec4(kInsideColor, 1.0);
  }
#endif
}
