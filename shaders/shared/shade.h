#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
const uint kPaletteWidth = 1024u;
const uint kPaletteLinear = 0u;
const uint kPaletteStep = 1u;
const uint kPaletteCategorical = 2u;
const uint kNoChunkUnit = 15u;
const uint kMaxShadeLayers = 64u;  // in a draw
const uint kPatternSolid = 0u;  // values of strata::Pattern
const uint kPatternHatch = 1u;
const uint kPatternDots = 2u;
const uint kPatternOutline = 3u;
const uint kBlendNormal = 0u;  // values of strata::LayerBlend
const uint kBlendMultiply = 1u;
const uint kBlendScreen = 2u;
const uint kNoPatterns = 0u;  // all points are solid
const uint kPatterns = 1u;
const uint kBarePatterns = 2u;  // hatch and dots have neither tint nor border
// Sizes of patterns, in pixels of the camera's window: on a figure these are hundredths of an inch
// of paper.
const float kPatternPixels = 7.0;         // between lines or dots without a spacing of their own
const float kPatternClosestPixels = 6.0;  // of closer ones every 2nd, 4th… is drawn
const float kPatternGround = 0.3;         // opacity of the color between lines or dots
const float kHatchShare = 0.4;            // share of the spacing that the line covers
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
  uint others;            // color of unlisted values, red in the low byte
  uint has_others;        // 0: unlisted values get a generated color
  uint patterns;          // kNoPatterns, kPatterns or kBarePatterns
  uint blend;
};

// A palette point: the bits of the value and the color, red in the low byte. Step: `key` is a
// float, ascending. Categorical: `key` is the texel's bits, ascending as unsigned. `pattern`: 2
// bits of kind, 14 bits of angle (2^14 is 180 degrees), 16 bits of the spacing in mm as a half
// float, 0: no spacing.
struct PalettePoint {
  uint key;
  uint color;
  uint pattern;
};

struct ShadeUniforms {
  vec4 background_top;
  vec4 background_bottom;
  // x, y: pixel of the patterns' origin, from the bottom left; z: mm in a pixel there; w: pixels
  // for one of the camera's
  vec4 patterns;
  uint picture_height;
  uint layer_count;
  uint unused_a, unused_b;
};
STRATA_SHARED_END
#ifdef __cplusplus
#include <cstddef>
static_assert(sizeof(strata::shader::ShadeLayer) == 64);
static_assert(sizeof(strata::shader::PalettePoint) == 12);
static_assert(sizeof(strata::shader::ShadeUniforms) == 64);
static_assert(offsetof(strata::shader::ShadeUniforms, picture_height) == 48);
#endif
