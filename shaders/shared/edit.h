#pragma once
#include "shared/section.h"
#include "shared/types.h"
STRATA_SHARED_BEGIN
// One piece of a stroke in window pixels, origin lower left. `tool`: radius at the start, radius at
// the end, the distance along the axis by which a point's nearest disc center is moved per unit of
// distance from the axis (0 for equal radii), length.
struct EditSegment {
  vec4 ends;  // start x, y, end x, y
  vec4 tool;
};

// A part of the block tree (mesh/surface/block_tree.h): a block or some of its texels. `place` is
// the tile, row-major, with the block's x from bit 16 and its y from bit 20.
struct EditPart {
  uint slot;
  uint place;
};

// A part that the stroke may touch. Bit i of `segments` means the segments from i *
// segments_per_bit on.
struct TouchedPart {
  uint part;
  uint segments;
};

const uint kEditMostTiles = 16384u;  // 16384 / 128 squared

// The numbers of parts and tiles that the stroke may touch, and the tiles in no particular order.
// `number_of_tile` is 0 for untouched tiles, otherwise the tile's index in the list plus one.
struct EditTiles {
  uint part_count;
  uint tile_count;
  uint tiles[kEditMostTiles];
  uint number_of_tile[kEditMostTiles];
};

// The texels of a tile that the edit wrote: 128 rows of texels, a bit each, lowest first; and the
// box around the spheres of the written parts, as numbers that increase with the float (`low`:
// decrease), 0 if nothing was written.
struct EditedTile {
  uint texels[512];
  uint low[3];
  uint high[3];
};

const uint kEditErase = 1u;
const uint kEditThrough = 2u;
const uint kEditSquare = 4u;
const uint kEditFixedBias = 8u;
const uint kEditFacing = 16u;  // too slanted surfaces are left out

const uint kShapeCells = 256u;  // a side of the texture of a tool's shape

// The members after the first 144 bytes are uploaded only if used.
struct EditUniforms {
  mat4 clip_from_model;
  vec4 window;    // width, height in pixels; then 0
  vec4 tool_box;  // of all segments in window pixels: x0, y0, x1, y1
  // fixed; scale of 1/w^2; slope factor; limit of the slope part, in units of the scaled part
  vec4 bias;
  uint value;
  uint flags;
  uint section_count;
  uint segment_count;
  uint segments_per_bit;
  uint part_count;
  uint table_offset;   // of the layer in the page tables
  float inner_radius;  // share of the tool's radius that it fills completely
  // for kEditFacing; render/edit/facing_limit.h: rows x, y, w, far; the last number of the first is
  // the limit
  vec4 facing[4];
  vec4 section[kSectionPlanes];  // the first section_count are used
};

const uint kEditPartsPerNode = 64u;  // of a node of the tree's third level
const uint kEditRowsPerBlock = 8u;   // one thread a row of 8 texels
const uint kEditPartsPerGroup = 8u;
const uint kEditGroupsPerRow = 32768u;  // below the 65 535 that every driver allows

// Culling uses floats; their rounding, and that of packed positions, is far smaller.
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
