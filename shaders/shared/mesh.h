#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
struct MeshUniforms {
  mat4 clip_from_model;
  vec4 eye;        // model space; w 1: a point (perspective), w 0: direction towards the eye (orthographic)
  vec4 key_light;  // unit directions in model space, fixed to the camera; w unused
  vec4 fill_light;
  vec4 up;
};
const uint kBackground = 0xffffffffu;  // texture coordinate of a pixel that shows no surface
STRATA_SHARED_END
#ifdef __cplusplus
#include <cstddef>
static_assert(sizeof(strata::shader::MeshUniforms) == 128);
static_assert(offsetof(strata::shader::MeshUniforms, up) == 112);
#endif
