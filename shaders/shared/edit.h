#pragma once
#include "shared/section.h"
#include "shared/types.h"
STRATA_SHARED_BEGIN
// One segment of a stroke in window pixels, origin lower left. `tool` contains: x, y: the radius at
// the start and at the end; z: the shift of a point's nearest disc center along the axis, per unit
// of distance from the axis (0 for equal radii); w: the length.
struct EditSegment {
  vec4 ends;  // start x, y, end x, y
  vec4 tool;
};

// A part of the block tree (mesh/surface/block_tree.h): a block or some of its texels. `place`
// contains the row-major tile number in bits 0 to 15, the block's x from bit 16, and its y from bit
// 20.
struct EditPart {
  uint slot;
  uint place;
};

// A part that the stroke may touch. Bit i of `segments` means segments_per_bit segments,
// starting at i * segments_per_bit.
struct TouchedPart {
  uint part;
  uint segments;
};

const uint kEditMostTiles = 16384u;  // (16384 / 128) squared

// The numbers of parts and tiles that the stroke may touch, and the tiles in any order.
// `number_of_tile` is 0 for an untouched tile, otherwise the tile's index in `tiles` plus one.
struct EditTiles {
  uint part_count;
  uint tile_count;
  uint tiles[kEditMostTiles];
  uint number_of_tile[kEditMostTiles];
};

// The texels of a tile that the edit wrote, and the bounding box of the bounding spheres of the
// written parts. `texels` contains 128 rows with one bit per texel, lowest bit first. The numbers
// in `high` increase with the coordinate, and the numbers in `low` decrease. All numbers are 0 if
// no texel was written.
struct EditedTile {
  uint texels[512];
  uint low[3];
  uint high[3];
};

const uint kEditErase = 1u;
const uint kEditThrough = 2u;
const uint kEditSquare = 4u;
const uint kEditFixedBias = 8u;
const uint kEditFacing = 16u;  // does not paint surfaces that are too slanted

const uint kShapeCells = 256u;  // cells along a side of the texture of a tool shape

// The members after the first 144 bytes are uploaded only if they are used.
struct EditUniforms {
  mat4 clip_from_model;
  vec4 window;    // width and height in pixels, 0, 0
  vec4 tool_box;  // box of all segments in window pixels: x0, y0, x1, y1
  // fixed bias; scale of 1/w^2; slope factor; limit of the slope part, in units of the scaled part
  vec4 bias;
  uint value;
  uint flags;
  uint section_count;
  uint segment_count;
  uint segments_per_bit;
  uint part_count;
  uint table_offset;   // the layer's first entry in the page tables
  float inner_radius;  // share of the tool's radius in which all points are inside the tool
  // For kEditFacing: the rows x, y, w and far of render/edit/facing_limit.h. facing[0].w is the
  // limit.
  vec4 facing[4];
  vec4 section[kSectionPlanes];  // only the first section_count are used
};

const uint kEditPartsPerNode = 64u;  // parts of a node in the third level of the block tree
const uint kEditRowsPerBlock = 8u;   // one thread for each row of 8 texels
const uint kEditPartsPerGroup = 8u;
const uint kEditGroupsPerRow = 32768u;  // all drivers allow at least 65 535

// The margins are much larger than the rounding of floats and of packed positions.
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
