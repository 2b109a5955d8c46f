#pragma once
#include "shared/mesh.h"
#ifndef __cplusplus
// Lighting multiplies stored colors by a factor. Stored colors are approximately the square roots
// of light, so the factor is the square root of the sum of the lights.

// The default light. It consists of three soft lights and a sky that is brighter at the top. The
// key light comes from the upper left, the fill light from the right, and the rim light from
// behind. On a plane that faces the eye the light is 0.97, so layers have the colors of their
// legends. Light above that value is reduced to a third, so bright stone keeps its detail. The
// light from all around changes slowly over a surface and is computed at the vertices. `openness`
// is the share of the sky that reaches a vertex.
float light_from_around(vec3 normal, float openness, MeshUniforms mesh) {
  float fill = max(0.0, dot(normal, mesh.fill_light.xyz) * 0.71 + 0.29);
  float sky = 0.5 + 0.5 * dot(normal, mesh.up.xyz);
  return openness * (0.26 * fill + 0.12 + 0.19 * sky);
}

float museum_light(vec3 normal, float from_around, MeshUniforms mesh) {
  float key = max(0.0, dot(normal, mesh.key_light.xyz) * 0.83 + 0.17);
  float rim = max(0.0, dot(normal, mesh.rim_light.xyz));
  float light = sqrt(0.73 * key + 0.26 * rim + from_around);
  return min(light, 0.65 + 0.33 * light);
}

// Compresses colors that are too bright for the frame, and keeps their hue.
vec3 tone_mapped(vec3 color) {
  const float kKnee = 0.9, kRest = 1.0 - kKnee;
  float peak = max(color.r, max(color.g, color.b));
  float over = max(0.0, peak - kKnee);
  return color * (min(peak, kKnee) + kRest * over / (over + kRest)) / max(peak, 1e-4);
}

// Lighting is two-sided, because scans are open and their windings are not always correct. At
// silhouettes a smooth normal may point away from the eye although the front is visible. Therefore
// only normals that clearly point away are reversed.
const float kFromBehind = -0.3;  // cosine
bool is_seen_from_behind(float cosine_to_eye) { return cosine_to_eye < kFromBehind; }
// The same test for a direction of any length, without a square root.
bool is_seen_from_behind(vec3 normal, vec3 to_eye) {
  float along = dot(normal, to_eye);
  return along < 0.0 && along * along > kFromBehind * kFromBehind * dot(to_eye, to_eye);
}
#endif
