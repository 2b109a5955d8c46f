#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
const uint kPaletteWidth = 1024u;
const uint kPaletteLinear = 0u;
const uint kPaletteStep = 1u;
const uint kPaletteCategorical = 2u;
const uint kNoChunkUnit = 15u;
const uint kMaxShadeLayers = 64u;  // in a draw

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
};

// A palette point: the bits of the value and the colour, red in the low byte. Step: `key` is a float, ascending.
// Categorical: `key` is the texel's bits, ascending as unsigned.
struct PalettePoint {
  uint key;
  uint color;
};

struct ShadeUniforms {
  vec4 background_top;
  vec4 background_bottom;
  uint picture_height;
  uint layer_count;
  uint first_pass;  // 1: start from the surface; 0: over what earlier draws made
  uint unused;
};
STRATA_SHARED_END
#ifdef __cplusplus
#include <cstddef>
static_assert(sizeof(strata::shader::ShadeLayer) == 48);
static_assert(sizeof(strata::shader::PalettePoint) == 8);
static_assert(sizeof(strata::shader::ShadeUniforms) == 48);
static_assert(offsetof(strata::shader::ShadeUniforms, picture_height) == 32);
#endif
