#pragma once
#include "shared/section.h"
#include "shared/types.h"
STRATA_SHARED_BEGIN
// One piece of a stroke in window pixels, origin lower left. `tool` is: radius at the start, radius at the end, how far along
// the axis a point's nearest disc centre is moved per unit of distance from the axis (0 for equal radii), length.
struct EditSegment {
  vec4 ends;  // start x, y, end x, y
  vec4 tool;
};

// One 8 x 8 block to test. `segments` is an index into the list of segment numbers; `place` is block x | block y << 4 in the
// tile, with the count of segments above bit 8.
struct EditBlock {
  uint slot;
  uint page;
  uint segments;
  uint place;
};

const uint kEditErase = 1u;
const uint kEditThrough = 2u;
const uint kEditSquare = 4u;
const uint kEditFixedBias = 8u;
const uint kEditFacing = 16u;  // surfaces seen at too much of a slant are left out

const uint kShapeCells = 256u;  // a side of the texture of a tool's shape

struct EditUniforms {
  mat4 clip_from_model;
  vec4 window;        // width, height in pixels; then 0
  vec4 bias;          // fixed; scale of 1/w^2; slope factor; limit of the slope part, in units of the scaled part
  uint value;
  uint flags;
  uint section_count;
  uint reserved;
  vec4 section[kSectionPlanes];  // section_count are used
  vec4 facing[4];                // render/facing_limit.h: rows x, y, w, far; the last number of the first is the limit
};

const uint kEditRowsPerBlock = 8u;   // one thread a row of 8 texels
const uint kEditBlocksPerGroup = 8u;
const uint kEditGroupsPerRow = 32768u;  // below the 65 535 that every driver allows
STRATA_SHARED_END
#ifdef __cplusplus
#include <cstddef>
static_assert(sizeof(strata::shader::EditSegment) == 32);
static_assert(sizeof(strata::shader::EditBlock) == 16);
static_assert(sizeof(strata::shader::EditUniforms) == 272);
static_assert(offsetof(strata::shader::EditUniforms, value) == 96);
#endif
