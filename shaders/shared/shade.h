#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
const uint kPaletteWidth = 1024u;
const uint kPaletteLinear = 0u;
const uint kPaletteStep = 1u;
const uint kPaletteCategorical = 2u;
const uint kNoChunkUnit = 15u;
const uint kMaxShadeLayers = 64u;  // per draw
const uint kPatternSolid = 0u;  // the patterns have the values of strata::Pattern
const uint kPatternHatch = 1u;
const uint kPatternDots = 2u;
const uint kPatternOutline = 3u;
const uint kBlendNormal = 0u;  // the blending modes have the values of strata::LayerBlend
const uint kBlendMultiply = 1u;
const uint kBlendScreen = 2u;
const uint kNoPatterns = 0u;  // all points are solid
const uint kPatterns = 1u;
const uint kBarePatterns = 2u;  // hatch and dots have neither tint nor border
// Sizes of patterns, in pixels of the camera's window. In a figure such a pixel is a hundredth of
// an inch on paper.
const float kPatternPixels = 7.0;         // between lines or dots if the palette sets no spacing
const float kPatternClosestPixels = 6.0;  // of closer lines or dots, only every 2nd, 4th … is drawn
const float kPatternGround = 0.3;         // opacity between lines or dots
const float kHatchShare = 0.4;            // the line's share of the spacing
const float kDotRadius = 0.32;            // as a share of the spacing
const float kOutlinePixels = 2.0;         // width of the border around a value

// One layer of a view. `type` has the values of strata::ValueType.
struct ShadeLayer {
  uint table;             // index of its first entry in the page tables
  uint resolution_bits;   // log2 of the texels along a side
  uint type;
  uint mode;
  uint row;               // row in the palette texture (linear)
  uint points;            // index of its first point (step, categorical)
  uint point_count;
  float opacity;
  float palette_min;
  float palette_max;      // above palette_min if mode is linear
  uint units_low;         // 4 bits per chunk: its bound pair of textures, or kNoChunkUnit
  uint units_high;
  uint others;            // color of unlisted values, red in the low byte
  uint has_others;        // 0: unlisted values get a generated color
  uint patterns;          // kNoPatterns, kPatterns or kBarePatterns
  uint blend;
};

// A palette point: the bits of the value, and the color with red in the low byte. Points are in
// ascending order of `key`: a float in step palettes, the bits of the texel as an unsigned number
// in categorical palettes. `pattern` contains 2 bits for the kind and 14 bits for the angle (2^14
// is 180 degrees). Its upper 16 bits are the spacing in mm as a half float. 0: no spacing.
struct PalettePoint {
  uint key;
  uint color;
  uint pattern;
};

struct ShadeUniforms {
  vec4 background_top;
  vec4 background_bottom;
  // x, y: origin of the patterns in pixels from the bottom left; z: millimeters per pixel there; w:
  // frame pixels per pixel of the camera's window
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
