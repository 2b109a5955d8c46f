#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
const uint kPaletteWidth = 1024u;
const uint kPaletteLinear = 0u;
const uint kPaletteStep = 1u;
const uint kPaletteCategorical = 2u;
const uint kNoChunkUnit = 15u;
const uint kMaxShadeLayers = 64u;  // in a draw
const uint kPatternSolid = 0u;  // as strata::Pattern
const uint kPatternHatch = 1u;
const uint kPatternDots = 2u;
const uint kPatternOutline = 3u;
// Of patterns, in pixels of the camera's window: on a figure these are hundredths of an inch of paper.
const float kPatternPixels = 7.0;         // between lines or dots that have no spacing of their own
const float kPatternClosestPixels = 6.0;  // closer ones are drawn every 2nd, 4th… instead
const float kPatternGround = 0.3;         // how much of the colour lies between lines or dots
const float kHatchShare = 0.4;            // of the spacing that is line
const float kDotRadius = 0.32;            // in spacings
const float kOutlinePixels = 2.0;         // of the border around a value

// One layer of a view. The order of `type` is that of strata::ValueType.
struct ShadeLayer {
  uint table;             // index of its page table in the table of all layers
  uint resolution_bits;   // log2 of the texels a side
  uint type;
  uint mode;
  uint row;               // of the palette texture (linear)
  uint points;            // first of its points (step, categorical)
  uint point_count;
  float opacity;
  float palette_min;
  float palette_max;      // above palette_min where mode is linear
  uint units_low;         // 4 bits a chunk: the bound pair of textures, or kNoChunkUnit
  uint units_high;
  uint others;            // colour of unlisted values, red in the low byte
  uint has_others;        // 0: unlisted values get a generated colour
  uint patterned;         // some point is not solid
  uint bare;              // hatch and dots have neither tint nor border
};

// A palette point: the bits of the value and the colour, red in the low byte. Step: `key` is a float, ascending.
// Categorical: `key` is the texel's bits, ascending as unsigned.
// `pattern`: 2 bits of kind, 14 bits of angle (2^14 is 180 degrees), 16 bits of the spacing in mm as a half float, 0: none.
struct PalettePoint {
  uint key;
  uint color;
  uint pattern;
};

struct ShadeUniforms {
  vec4 background_top;
  vec4 background_bottom;
  vec4 patterns;  // x, y: pixel that they are measured from, origin bottom left; z: mm in a pixel there; w: pixels in one of the camera's
  uint picture_height;
  uint layer_count;
  uint first_pass;  // 1: start from the surface; 0: over what earlier draws made
  uint unused;
};
STRATA_SHARED_END
#ifdef __cplusplus
#include <cstddef>
static_assert(sizeof(strata::shader::ShadeLayer) == 64);
static_assert(sizeof(strata::shader::PalettePoint) == 12);
static_assert(sizeof(strata::shader::ShadeUniforms) == 64);
static_assert(offsetof(strata::shader::ShadeUniforms, picture_height) == 48);
#endif
