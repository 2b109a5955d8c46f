#pragma once
#include "shared/mesh.h"
#ifndef __cplusplus
// Light is a factor of colors as they are stored. Stored colors are about the square roots of
// light, so sums of light become factors by a square root.

// The default light: a key from the upper left, a fill from the right and a rim from behind, all
// soft, and a sky that is brighter at the top. 0.97 on a plane that faces the eye: layers then have
// the colors of their legends. More light than that counts a third, so that bright stone keeps its
// detail. The light from all around changes slowly over a surface and is computed at its vertices;
// `openness` is the share of the sky that reaches them.
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

// Rolls off what is brighter than a picture can show, and keeps the hue.
vec3 tone_mapped(vec3 color) {
  const float kKnee = 0.9, kRest = 1.0 - kKnee;
  float peak = max(color.r, max(color.g, color.b));
  float over = max(0.0, peak - kKnee);
  return color * (min(peak, kKnee) + kRest * over / (over + kRest)) / max(peak, 1e-4);
}

// Two-sided: scans are open and their windings are not always right. At silhouettes smooth normals
// point away although the surface is not seen from behind, so only normals that clearly point away
// are reversed.
const float kFromBehind = -0.3;  // cosine
bool is_seen_from_behind(float cosine_to_eye) { return cosine_to_eye < kFromBehind; }
// The same for a direction of any length, without its square root.
bool is_seen_from_behind(vec3 normal, vec3 to_eye) {
  float along = dot(normal, to_eye);
  return along < 0.0 && along * along > kFromBehind * kFromBehind * dot(to_eye, to_eye);
}
#endif
