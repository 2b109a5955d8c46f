#pragma once
#include "shared/mesh.h"
#ifndef __cplusplus
// The default light: a soft key from the upper left, a weak fill from the camera's right, and a sky
// that is brighter at the top.
float museum_light(vec3 normal, MeshUniforms mesh) {
  float key = dot(normal, mesh.key_light.xyz);
  float wrapped = max(0.0, key * 0.8 + 0.2);
  float fill = max(0.0, dot(normal, mesh.fill_light.xyz));
  float sky = 0.5 + 0.5 * dot(normal, mesh.up.xyz);
  return min(0.22 + 0.18 * sky + 0.56 * wrapped * wrapped + 0.16 * fill, 1.0);
}

// Two-sided: scans are open and their windings are not always right. At silhouettes smooth normals
// point away although the surface is not seen from behind, so only normals that clearly point away
// are reversed.
bool is_seen_from_behind(float cosine_to_eye) { return cosine_to_eye < -0.3; }
#endif
