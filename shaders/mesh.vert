#version 450 core
#include "shared/mesh.h"
#include "shared/museum_light.h"
// The vertex stage of the mesh for g-buffers and for depth only. Both kinds of draws use it, so
// their depths are bitwise equal. With LIT_VERTICES, the museum light of small triangles is
// computed at their vertices instead of at each pixel.
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
layout(std140, binding = 0) uniform MeshBlock { MeshUniforms mesh; };

invariant gl_Position;
#ifdef SECTION
out float gl_ClipDistance[kSectionPlanes];
#endif
layout(location = 0) out vec2 surface_uv;
#ifndef LIT_VERTICES
layout(location = 1) out vec4 surface_normal;  // w: cosine of the angle to the eye
#endif
// The alpha is the light from all around, or all light with LIT_VERTICES.
layout(location = 2) out vec4 surface_color;

void main() {
  gl_Position = mesh.clip_from_model * vec4(position, 1.0);
  surface_uv = uv;
  vec3 to_eye = mesh.eye.xyz - position * mesh.eye.w;
#ifdef LIT_VERTICES
  vec3 facing = is_seen_from_behind(normal.xyz, to_eye) ? -normal.xyz : normal.xyz;
  surface_color = vec4(color.rgb, museum_light(facing, light_from_around(facing, color.a, mesh), mesh));
#else
  surface_normal = vec4(normal.xyz, dot(normal.xyz, normalize(to_eye)));
  vec3 facing = is_seen_from_behind(surface_normal.w) ? -normal.xyz : normal.xyz;
  surface_color = vec4(color.rgb, light_from_around(facing, color.a, mesh));
#endif
#ifdef SECTION
  for (uint i = 0u; i < kSectionPlanes; ++i) gl_ClipDistance[i] = dot(mesh.section[i].xyz, position) + mesh.section[i].w;
#endif
}
