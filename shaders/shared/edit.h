#pragma once
#include "shared/section.h"
#include "shared/types.h"
STRATA_SHARED_BEGIN
// One piece of a stroke in window pixels, origin lower left. `tool` is: radius at the start, radius
// at the end, how far along the axis a point's nearest disc centre is moved per unit of distance
// from the axis (0 for equal radii), length.
struct EditSegment {
  vec4 ends;  // start x, y, end x, y
  vec4 tool;
};

// A part of the block tree (mesh/surface/block_tree.h): a block or some of its texels. `place` is
// the tile, row-major, with the block's x above bit 16 and its y above bit 20.
struct EditPart {
  uint slot;
  uint place;
};

// A part that the stroke may touch. Bit i of `segments` stands for segments i * segments_per_bit
// and on.
struct TouchedPart {
  uint part;
  uint segments;
};

const uint kEditMostTiles = 16384u;  // 16384 / 128 squared

// How many parts and tiles the stroke may touch, and which tiles in no order. `number_of_tile` is 0
// where it touches none, else one above the tile's place in the list.
struct EditTiles {
  uint part_count;
  uint tile_count;
  uint tiles[kEditMostTiles];
  uint number_of_tile[kEditMostTiles];
};

// What the edit wrote in a tile: 128 rows of texels, a bit each, lowest first; and the box around
// the spheres of the parts it wrote in, as numbers that grow with the float (`low`: that shrink), 0
// where it wrote nothing.
struct EditedTile {
  uint texels[512];
  uint low[3];
  uint high[3];
};

const uint kEditErase = 1u;
const uint kEditThrough = 2u;
const uint kEditSquare = 4u;
const uint kEditFixedBias = 8u;
const uint kEditFacing = 16u;  // surfaces seen at too much of a slant are left out

const uint kShapeCells = 256u;  // a side of the texture of a tool's shape

// What follows the first 144 bytes is sent where it is used.
struct EditUniforms {
  mat4 clip_from_model;
  vec4 window;    // width, height in pixels; then 0
  vec4 tool_box;  // of all segments in window pixels: x0, y0, x1, y1
  vec4 bias;      // fixed; scale of 1/w^2; slope factor; limit of the slope part, in units of the
                  // scaled part
  uint value;
  uint flags;
  uint section_count;
  uint segment_count;
  uint segments_per_bit;
  uint part_count;
  uint table_offset;   // of the layer in the page tables
  float inner_radius;  // share of the tool's radius that it fills wholly
  vec4 facing[4];  // kEditFacing. render/edit/facing_limit.h: rows x, y, w, far; the last number of
                   // the first is the limit
  vec4 section[kSectionPlanes];  // section_count are used
};

const uint kEditPartsPerNode = 64u;  // of a node of the tree's third level
const uint kEditRowsPerBlock = 8u;   // one thread a row of 8 texels
const uint kEditPartsPerGroup = 8u;
const uint kEditGroupsPerRow = 32768u;  // below the 65 535 that every driver allows

// Culling computes in floats; what they and packed positions round is far less.
const float kCullMarginPx = 0.25;
const float kCullMarginDepth = 4e-6;
const float kCullMarginRadius = 1e-5;  // relative
STRATA_SHARED_END
#ifdef __cplusplus
#include <cstddef>
static_assert(sizeof(strata::shader::EditSegment) == 32);
static_assert(sizeof(strata::shader::EditPart) == 8);
static_assert(sizeof(strata::shader::TouchedPart) == 8);
static_assert(sizeof(strata::shader::EditedTile) == 2072);
static_assert(sizeof(strata::shader::EditUniforms) == 304);
static_assert(offsetof(strata::shader::EditUniforms, facing) == 144);
#else
uint tile_of(EditPart part) { return part.place & 0xffffu; }
uvec2 block_in_tile(EditPart part) { return uvec2(part.place >> 16, part.place >> 20) & 15u; }
#endif
