#version 450 core
#include "shared/depth_probe.h"
#include "shared/edit.h"
// Lists the parts of the block tree that a stroke may touch, and their tiles. Projects spheres to
// the window, and tests them against the tool's segments and the coarse grid of largest depths. The
// test is conservative: it never rejects a texel that the edit would write. A group tests a node of
// the tree and its 64 parts. Most groups end after the test of the node.
layout(local_size_x = 64) in;
layout(std140, binding = 0) uniform EditUniformBlock { EditUniforms edit; };
layout(std430, binding = 0) readonly buffer Nodes { vec4 nodes[]; };      // center, radius; per 64 parts
layout(std430, binding = 1) readonly buffer Spheres { vec4 spheres[]; };  // per part
layout(std430, binding = 2) readonly buffer Parts { EditPart parts[]; };
layout(std430, binding = 3) readonly buffer Segments { EditSegment segments[]; };
layout(std430, binding = 4) readonly buffer Cells { float cells[]; };
layout(std430, binding = 5) buffer Touched { EditTiles tiles; };
layout(std430, binding = 6) writeonly buffer TouchedParts { TouchedPart touched[]; };

shared uint node_segments, group_count, group_first;

struct WindowBox {
  vec4 box;  // x0, y0, x1, y1; the whole window if the eye's plane intersects the sphere
  float z0;  // nearest depth in the window
  float w0;  // smallest w
};

vec4 row(int i) {
  return vec4(edit.clip_from_model[0][i], edit.clip_from_model[1][i], edit.clip_from_model[2][i],
              edit.clip_from_model[3][i]);
}

// Returns the bounds of (a_row · p) / (w_row · p) over a sphere: the values k for which the plane
// a_row - k w_row touches the sphere. This form of the root avoids cancellation in float.
vec2 ratio_bounds(vec3 a_row, float a, vec3 w_row, float w, float radius) {
  float reach = radius * length(w_row);
  vec3 across = w * a_row - a * w_row, both = cross(a_row, w_row);
  float root = radius * sqrt(max(0.0, dot(across, across) - radius * radius * dot(both, both)));
  float middle = a * w - radius * radius * dot(a_row, w_row);
  return vec2(middle - root, middle + root) / ((w - reach) * (w + reach));
}

bool project(vec4 sphere, out WindowBox found) {
  float radius = sphere.w * (1.0 + kCullMarginRadius);
  vec4 w_row = row(3);
  vec4 clip = edit.clip_from_model * vec4(sphere.xyz, 1.0);
  float reach = radius * length(w_row.xyz);
  found = WindowBox(vec4(vec2(0.0), edit.window.xy), 0.0, 0.0);
  if (clip.w + reach <= 0.0) return false;
  if (clip.w - reach <= kCullMarginRadius * clip.w) return true;
  vec2 x = ratio_bounds(row(0).xyz, clip.x, w_row.xyz, clip.w, radius);
  vec2 y = ratio_bounds(row(1).xyz, clip.y, w_row.xyz, clip.w, radius);
  vec2 z = ratio_bounds(row(2).xyz, clip.z, w_row.xyz, clip.w, radius);
  if (z.y < -1.0 - kCullMarginDepth || z.x > 1.0 + kCullMarginDepth) return false;
  found.box = (vec4(x.x, y.x, x.y, y.y) * 0.5 + 0.5) * edit.window.xyxy + vec4(-kCullMarginPx, -kCullMarginPx, kCullMarginPx, kCullMarginPx);
  found.z0 = z.x * 0.5 + 0.5;
  found.w0 = clip.w - reach;
  return true;
}

bool overlap(vec4 a, vec4 b) { return all(lessThanEqual(a.xy, b.zw)) && all(lessThanEqual(b.xy, a.zw)); }

bool is_in_reach(vec4 box) {
  return overlap(box, vec4(vec2(0.0), edit.window.xy)) && overlap(box, edit.tool_box);
}

float distance_to_axis(EditSegment s, vec2 point) {
  vec2 along = s.ends.zw - s.ends.xy;
  float squared = dot(along, along);
  float t = squared > 0.0 ? clamp(dot(point - s.ends.xy, along) / squared, 0.0, 1.0) : 0.0;
  return distance(point, s.ends.xy + along * t);
}

// Tests the circle around the box against the segment's axis, because the box of a long slanted
// segment is much larger than the segment.
bool lies_under(vec4 box, EditSegment s) {
  float radius = max(s.tool.x, s.tool.y) * (1.0 + kCullMarginRadius);
  vec4 of_segment = vec4(min(s.ends.xy, s.ends.zw) - radius, max(s.ends.xy, s.ends.zw) + radius);
  vec2 center = 0.5 * (box.xy + box.zw);
  return overlap(box, of_segment) &&
         // √2: the distance to the corners of a square tool
         distance_to_axis(s, center) <= radius * sqrt(2.0) + distance(center, box.zw);
}

// Returns whether the segment covers the whole box. If it does, the other segments have no effect.
bool covers(EditSegment s, vec4 box) {
  vec2 center = 0.5 * (box.xy + box.zw);
  return distance_to_axis(s, center) + distance(center, box.zw) + kCullMarginPx < edit.inner_radius * min(s.tool.x, s.tool.y);
}

bool is_hidden(WindowBox window) {
  if ((edit.flags & kEditThrough) != 0u || window.w0 <= 0.0) return false;
  float bias = (edit.flags & kEditFixedBias) != 0u ? edit.bias.x
                                                   : edit.bias.y / (window.w0 * window.w0) * (1.0 + edit.bias.w);
  float nearest = window.z0 - bias - kCullMarginDepth;
  float cell = float(kDepthCell);
  ivec2 count = ivec2(ceil(edit.window.xy / cell));
  // Clamp before the cast, because a box near the eye may extend beyond the range of an int.
  ivec2 from = ivec2(clamp(floor(max(window.box.xy, edit.tool_box.xy) / cell), vec2(0.0), vec2(count - 1)));
  ivec2 to = ivec2(clamp(floor(min(window.box.zw, edit.tool_box.zw) / cell), vec2(0.0), vec2(count - 1)));
  for (int y = from.y; y <= to.y; ++y)
    for (int x = from.x; x <= to.x; ++x)
      if (cells[y * count.x + x] >= nearest) return false;
  return true;
}

// Returns the bits of the segments in `runs` that may cover the box.
uint segments_over(vec4 box, uint runs) {
  uint found = 0u;
  for (; runs != 0u; runs &= runs - 1u) {
    uint run = uint(findLSB(runs));
    uint first = run * edit.segments_per_bit, end = min(first + edit.segments_per_bit, edit.segment_count);
    for (uint i = first; i < end; ++i) {
      if (!lies_under(box, segments[i])) continue;
      if (covers(segments[i], box)) return 1u << run;
      found |= 1u << run;
    }
  }
  return found;
}

void mark(uint tile) {
  if (atomicCompSwap(tiles.number_of_tile[tile], 0u, 1u) != 0u) return;
  uint number = atomicAdd(tiles.tile_count, 1u) + 1u;
  tiles.number_of_tile[tile] = number;
  tiles.tiles[number - 1u] = tile;
}

void main() {
  uint group = gl_WorkGroupID.y * kEditGroupsPerRow + gl_WorkGroupID.x;
  if (group * kEditPartsPerNode >= edit.part_count) return;
  if (gl_LocalInvocationIndex == 0u) node_segments = group_count = 0u;
  barrier();
  WindowBox window;
  if (project(nodes[group], window) && is_in_reach(window.box))
    for (uint i = gl_LocalInvocationIndex; i < edit.segment_count; i += gl_WorkGroupSize.x)
      if (lies_under(window.box, segments[i])) atomicOr(node_segments, 1u << (i / edit.segments_per_bit));
  barrier();
  if (node_segments == 0u) return;

  uint part = group * kEditPartsPerNode + gl_LocalInvocationIndex;
  uint over = 0u, rank = 0u;
  if (part < edit.part_count && project(spheres[part], window) && is_in_reach(window.box)) {
    over = segments_over(window.box, node_segments);
    if (over != 0u && is_hidden(window)) over = 0u;
  }
  if (over != 0u) rank = atomicAdd(group_count, 1u);
  barrier();
  if (gl_LocalInvocationIndex == 0u && group_count > 0u) group_first = atomicAdd(tiles.part_count, group_count);
  barrier();
  if (over == 0u) return;
  touched[group_first + rank] = TouchedPart(part, over);
  mark(tile_of(parts[part]));
}
