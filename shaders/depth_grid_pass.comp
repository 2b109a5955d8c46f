#version 450 core
#include "shared/depth_probe.h"
// Computes the largest depth of each cell of the coarse grid. Any point behind this depth is hidden
// everywhere in the cell.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depth;
layout(std430, binding = 0) writeonly buffer Cells { float cells[]; };
layout(location = 0) uniform ivec2 cell_count;

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, cell_count))) return;
  ivec2 size = textureSize(depth, 0);
  ivec2 begin = cell * int(kDepthCell);
  ivec2 end = min(begin + int(kDepthCell), size);
  float deepest = 0.0;
  for (int y = begin.y; y < end.y; ++y)
    for (int x = begin.x; x < end.x; ++x) deepest = max(deepest, texelFetch(depth, ivec2(x, y), 0).r);
  cells[cell.y * cell_count.x + cell.x] = deepest;
}
