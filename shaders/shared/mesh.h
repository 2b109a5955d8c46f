#pragma once
#include "shared/section.h"
#include "shared/types.h"
STRATA_SHARED_BEGIN
struct MeshUniforms {
  mat4 clip_from_model;
  // model space; w 1: a point (perspective), w 0: direction towards the eye (orthographic)
  vec4 eye;
  // unit directions in model space, relative to the camera; w of the key light: strength of raking
  // light; of the fill light: its share in raking light; of the rim light: the factor of exposure
  vec4 key_light;
  vec4 fill_light;
  vec4 rim_light;
  vec4 up;
  vec4 section[kSectionPlanes];
  vec4 look_opacity;  // of images 0 to 3
  uint eye_is_cut_away;
  uint reserved_0;
  uint reserved_1;
  uint reserved_2;
};
const uint kMaxLooks = 4u;
const uint kBackground = 0xffffffffu;  // texture coordinate of a pixel without surface
STRATA_SHARED_END
#ifdef __cplusplus
#include <cstddef>
static_assert(sizeof(strata::shader::MeshUniforms) == 272);
static_assert(offsetof(strata::shader::MeshUniforms, up) == 128);
#endif
