#version 450 core
#include "shared/edit.h"
#include "shared/pages.h"
// Texture editing and padding in one dispatch. All texels of the blocks that edit_cull_pass.comp
// listed are projected to the window and tested as in the paper's texture editing algorithm. A
// gutter texel has its owner's position, so it needs no second pass. One thread processes a row of
// 8 texels. If several parts of a block are listed, the block is written several times with the
// same values. TEXEL_FORMAT is r8ui, r16ui or r32ui. With TOOL_TEXTURE the tool is a texture of
// distances to the nearest cell of its shape.
layout(local_size_x = 64) in;
layout(std140, binding = 0) uniform EditUniformBlock { EditUniforms edit; };
layout(std430, binding = 0) readonly buffer PageTables { uint page_tables[]; };
layout(std430, binding = 1) readonly buffer Spheres { vec4 spheres[]; };  // per part: center, radius
layout(std430, binding = 2) readonly buffer Parts { EditPart parts[]; };
layout(std430, binding = 3) readonly buffer Segments { EditSegment segments[]; };
layout(std430, binding = 4) readonly buffer PackedBoxes { float packed_boxes[]; };  // per slot: min x y z, step x y z
layout(std430, binding = 5) readonly buffer Touched { EditTiles tiles; };
layout(std430, binding = 6) readonly buffer TouchedParts { TouchedPart touched[]; };
// The index is the tile's index in EditTiles::tiles.
layout(std430, binding = 7) buffer Edited { EditedTile edited[]; };
layout(binding = 0) uniform usampler2DArray positions;
layout(binding = 1) uniform sampler2D depth;
#ifdef TOOL_TEXTURE
layout(binding = 2) uniform usampler2D shape_distances;
#endif
layout(TEXEL_FORMAT, binding = 0) uniform writeonly uimage2DArray values;
layout(r8ui, binding = 1) uniform writeonly uimage2DArray valid;
// A dispatch binds the pages of one chunk. The first dispatch also processes blocks without a page.
layout(location = 0) uniform uint chunk;
layout(location = 1) uniform uint is_first_chunk;

shared uint part_is_written[kEditPartsPerGroup];

#ifdef TOOL_TEXTURE

// Returns whether a line between two points of the shape's raster meets a set cell. Each step
// leaves the empty square of cells around the current cell. Therefore only a few steps are needed,
// at most one for each cell along the line.
bool meets_shape(vec2 a, vec2 b) {
  const float side = float(kShapeCells);
  vec2 d = b - a;
  float low = 0.0, high = 1.0;
  for (int i = 0; i < 2; ++i) {
    if (d[i] == 0.0) {
      if (a[i] < 0.0 || a[i] >= side) return false;
    } else {
      float t0 = -a[i] / d[i], t1 = (side - a[i]) / d[i];
      low = max(low, min(t0, t1));
      high = min(high, max(t0, t1));
    }
  }
  if (low > high) return false;
  ivec2 cell = clamp(ivec2(floor(a + low * d)), ivec2(0), ivec2(kShapeCells - 1u));
  for (uint step = 0u; step < 2u * kShapeCells; ++step) {
    int distance = int(texelFetch(shape_distances, cell, 0).r);
    if (distance == 0) return true;
    ivec2 first = cell - distance + 1, end = cell + distance;
    float tx = d.x == 0.0 ? 2.0 : (float(d.x > 0.0 ? end.x : first.x) - a.x) / d.x;
    float ty = d.y == 0.0 ? 2.0 : (float(d.y > 0.0 ? end.y : first.y) - a.y) / d.y;
    if (min(tx, ty) > high) return false;
    if (tx <= ty) {
      cell = ivec2(d.x > 0.0 ? end.x : first.x - 1, clamp(int(floor(a.y + tx * d.y)), first.y, end.y - 1));
    } else {
      cell = ivec2(clamp(int(floor(a.x + ty * d.x)), first.x, end.x - 1), d.y > 0.0 ? end.y : first.y - 1);
    }
    if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(kShapeCells)))) return false;
  }
  return false;
}

// Maps a window point into the shape's raster at both ends of the segment. The raster's first row
// is the top row.
bool in_segment(vec2 p, EditSegment s) {
  const vec2 center = vec2(0.5 * float(kShapeCells)), half_side = vec2(0.5, -0.5) * float(kShapeCells);
  return meets_shape(center + (p - s.ends.xy) * (half_side / s.tool.x), center + (p - s.ends.zw) * (half_side / s.tool.y));
}

#else

bool in_disc(vec2 p, EditSegment s) {
  vec2 a = s.ends.xy;
  float along = 0.0;
  vec2 axis = vec2(0.0);
  if (s.tool.w > 0.0) {
    axis = (s.ends.zw - a) / s.tool.w;
    float x = dot(p - a, axis);
    float y = abs(dot(p - a, vec2(-axis.y, axis.x)));
    along = clamp(x + y * s.tool.z, 0.0, s.tool.w);
  }
  float radius = s.tool.w > 0.0 ? mix(s.tool.x, s.tool.y, along / s.tool.w) : max(s.tool.x, s.tool.y);
  vec2 d = p - (a + axis * along);
  return dot(d, d) < radius * radius;
}

// A point is inside the swept square if, for some t in [0, 1], it is inside the square around a + t
// (b - a). These are four linear conditions c + t g > 0.
bool in_square(vec2 p, EditSegment s) {
  vec2 a = p - s.ends.xy;
  vec2 step = s.ends.zw - s.ends.xy;
  float grow = s.tool.y - s.tool.x;
  vec4 c = vec4(s.tool.x - a, s.tool.x + a);
  vec4 g = vec4(grow + step, grow - step);
  float low = 0.0, high = 1.0;
  for (int i = 0; i < 4; ++i) {
    if (g[i] == 0.0) {
      if (c[i] <= 0.0) return false;
    } else {
      float t = -c[i] / g[i];
      if (g[i] > 0.0) low = max(low, t);
      else high = min(high, t);
    }
  }
  return low < high || (low == high && s.tool.w == 0.0);
}

bool in_segment(vec2 p, EditSegment s) { return (edit.flags & kEditSquare) != 0u ? in_square(p, s) : in_disc(p, s); }

#endif

bool in_tool(vec2 p, uint runs) {
  for (; runs != 0u; runs &= runs - 1u) {
    uint first = uint(findLSB(runs)) * edit.segments_per_bit, end = min(first + edit.segments_per_bit, edit.segment_count);
    for (uint i = first; i < end; ++i)
      if (in_segment(p, segments[i])) return true;
  }
  return false;
}

// On a slanted surface, the depths of a texel and of the pixel's center differ by up to the change
// of depth within half a pixel. The smaller of two one-sided differences gives this slope without
// errors at silhouettes.
float depth_bias(ivec2 pixel, float here, float w) {
  if ((edit.flags & kEditFixedBias) != 0u) return edit.bias.x;
  ivec2 last = textureSize(depth, 0) - 1;
  float left = texelFetch(depth, ivec2(max(pixel.x - 1, 0), pixel.y), 0).r;
  float right = texelFetch(depth, ivec2(min(pixel.x + 1, last.x), pixel.y), 0).r;
  float below = texelFetch(depth, ivec2(pixel.x, max(pixel.y - 1, 0)), 0).r;
  float above = texelFetch(depth, ivec2(pixel.x, min(pixel.y + 1, last.y)), 0).r;
  float slope = min(abs(here - left), abs(right - here)) + min(abs(here - below), abs(above - here));
  float base = edit.bias.y / (w * w);
  return base + min(edit.bias.z * slope, edit.bias.w * base);
}

// Tests the limit that render/edit/facing_limit.h describes. At the window's border, uses the
// neighbor that exists. Rejects pixels without surface.
bool is_facing(ivec2 pixel, float here) {
  ivec2 last = textureSize(depth, 0) - 1;
  float left = here - texelFetch(depth, ivec2(max(pixel.x - 1, 0), pixel.y), 0).r;
  float right = texelFetch(depth, ivec2(min(pixel.x + 1, last.x), pixel.y), 0).r - here;
  float below = here - texelFetch(depth, ivec2(pixel.x, max(pixel.y - 1, 0)), 0).r;
  float above = texelFetch(depth, ivec2(pixel.x, min(pixel.y + 1, last.y)), 0).r - here;
  bool is_left = (abs(left) <= abs(right) && pixel.x > 0) || pixel.x == last.x;
  bool is_below = (abs(below) <= abs(above) && pixel.y > 0) || pixel.y == last.y;
  vec2 slope = vec2(is_left ? left : right, is_below ? below : above) * edit.window.xy;
  vec2 center = (vec2(pixel) + 0.5) * 2.0 / edit.window.xy - 1.0;
  vec3 w_row = edit.facing[2].xyz;
  vec3 a = edit.facing[0].xyz - center.x * w_row, b = edit.facing[1].xyz - center.y * w_row;
  vec3 ray = cross(a, b);
  vec3 normal = slope.x * a + slope.y * b + edit.facing[3].xyz - 2.0 * (1.0 - here) * w_row;
  float along = dot(normal, ray);
  return here < 1.0 && along * along >= edit.facing[0].w * dot(normal, normal) * dot(ray, ray);
}

bool painted(uvec2 packed_position, vec3 box_min, vec3 box_step, uint runs) {
  vec3 q = vec3(packed_position.x & 0x1fffffu, (packed_position.x >> 21) | ((packed_position.y & 0x3ffu) << 11),
                packed_position.y >> 10);
  vec3 position = box_min + q * box_step;
  for (uint i = 0u; i < edit.section_count; ++i)
    if (dot(edit.section[i].xyz, position) + edit.section[i].w < 0.0) return false;
  vec4 clip = edit.clip_from_model * vec4(position, 1.0);
  if (clip.w <= 0.0 || abs(clip.z) > clip.w) return false;
  vec3 ndc = clip.xyz / clip.w;
  vec2 window = (ndc.xy * 0.5 + 0.5) * edit.window.xy;
  if (any(lessThan(window, vec2(0.0))) || any(greaterThanEqual(window, edit.window.xy))) return false;
  if (!in_tool(window, runs)) return false;
  if ((edit.flags & kEditThrough) != 0u) return true;
  ivec2 pixel = ivec2(window);
  float here = texelFetch(depth, pixel, 0).r;
  if (edit.section_count > 0u && (floatBitsToUint(here) & kInsideMark) != 0u) return false;
  if (ndc.z * 0.5 + 0.5 - depth_bias(pixel, here, clip.w) > here) return false;
  return (edit.flags & kEditFacing) == 0u || is_facing(pixel, here);
}

// Paints a row and returns the bits of the written texels, lowest first. If `page` is kNoPage, an
// eraser writes no texels, but their bits are still returned.
uint paint_row(EditPart part, uint y, uint page, uint runs) {
  uint element = part.slot * 64u + y * 8u;
  ivec3 source = ivec3(element & (kPositionRow - 1u), (element >> kPositionRowBits) & (kPositionRow - 1u),
                       element >> kPositionSliceBits);
  ivec3 target = page_origin(page) + ivec3(block_in_tile(part) * 8u + uvec2(0u, y), 0);
  uint value = (edit.flags & kEditErase) != 0u ? 0u : edit.value;
  uint flag = (edit.flags & kEditErase) != 0u ? 0u : 1u;
  uint box = part.slot * 6u;
  vec3 box_min = vec3(packed_boxes[box], packed_boxes[box + 1u], packed_boxes[box + 2u]);
  vec3 box_step = vec3(packed_boxes[box + 3u], packed_boxes[box + 4u], packed_boxes[box + 5u]);
  uint written = 0u;
  for (int x = 0; x < 8; ++x) {
    uvec2 position = texelFetch(positions, source + ivec3(x, 0, 0), 0).rg;
    if (position == uvec2(0xffffffffu) || !painted(position, box_min, box_step, runs)) continue;
    if (page != kNoPage) {
      imageStore(values, target + ivec3(x, 0, 0), uvec4(value));
      imageStore(valid, target + ivec3(x, 0, 0), uvec4(flag));
    }
    written |= 1u << x;
  }
  return written;
}

uint ordered(float value) {
  uint bits = floatBitsToUint(value);
  return (bits >> 31) != 0u ? ~bits : bits | 0x80000000u;
}

// Most parts of a tile are inside the box of the previous parts. The comparison avoids atomic
// operations for them.
void widen_box(uint tile, vec4 sphere) {
  for (int i = 0; i < 3; ++i) {
    uint low = ~ordered(sphere[i] - sphere.w), high = ordered(sphere[i] + sphere.w);
    if (low > edited[tile].low[i]) atomicMax(edited[tile].low[i], low);
    if (high > edited[tile].high[i]) atomicMax(edited[tile].high[i], high);
  }
}

void main() {
  uint group = gl_WorkGroupID.y * kEditGroupsPerRow + gl_WorkGroupID.x;
  uint in_group = gl_LocalInvocationIndex / kEditRowsPerBlock, y = gl_LocalInvocationIndex % kEditRowsPerBlock;
  uint number = group * kEditPartsPerGroup + in_group;
  if (gl_LocalInvocationIndex < kEditPartsPerGroup) part_is_written[gl_LocalInvocationIndex] = 0u;
  barrier();
  TouchedPart it = TouchedPart(0u, 0u);
  uint tile = 0u;
  if (number < tiles.part_count) {
    it = touched[number];
    EditPart part = parts[it.part];
    uint page = page_tables[edit.table_offset + tile_of(part)];
    if (page == kNoPage ? is_first_chunk != 0u : page >> kPageChunkShift == chunk) {
      tile = tiles.number_of_tile[tile_of(part)] - 1u;
      uint written = paint_row(part, y, page, it.segments);
      if (written != 0u) {
        uvec2 block = block_in_tile(part);
        uint texel = (block.y * 8u + y) * kTileTexels + block.x * 8u;
        atomicOr(edited[tile].texels[texel / 32u], written << (texel % 32u));
        atomicOr(part_is_written[in_group], 1u);
      }
    }
  }
  barrier();
  if (y == 0u && part_is_written[in_group] != 0u) widen_box(tile, spheres[it.part]);
}
