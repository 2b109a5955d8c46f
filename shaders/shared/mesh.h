#pragma once
#include "shared/section.h"
#include "shared/types.h"
STRATA_SHARED_BEGIN
struct MeshUniforms {
  mat4 clip_from_model;
  // In model space. With w = 1 a point (perspective), with w = 0 the direction towards the eye
  // (orthographic).
  vec4 eye;
  // Unit directions in model space that follow the camera. key_light.w is the strength of raking
  // light, fill_light.w the share of the fill light in raking light, rim_light.w the factor of
  // exposure.
  vec4 key_light;
  vec4 fill_light;
  vec4 rim_light;
  vec4 up;
  vec4 section[kSectionPlanes];
  vec4 look_opacity;  // opacities of the surface images 0 to 3
  uint eye_is_cut_away;
  uint reserved_0;
  uint reserved_1;
  uint reserved_2;
};
const uint kMaxLooks = 4u;
const uint kBackground = 0xffffffffu;  // texture coordinate of pixels without surface
STRATA_SHARED_END
#ifdef __cplusplus
#include <cstddef>
static_assert(sizeof(strata::shader::MeshUniforms) == 272);
static_assert(offsetof(strata::shader::MeshUniforms, up) == 128);
#endif
