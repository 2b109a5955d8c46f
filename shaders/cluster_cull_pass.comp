#version 450 core
#include "shared/cluster.h"
#include "shared/depth_probe.h"
// Disables the draws of hidden clusters. A cluster is hidden if its box is behind the depth drawn
// so far in all cells of the coarse grid that the box overlaps. One level of the grid is enough,
// because few boxes overlap many cells. The loop ends at the first cell in which the box is
// visible.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Cells { float cells[]; };
layout(std430, binding = 1) readonly buffer Boxes { float boxes[]; };  // per cluster: min x y z, max x y z
layout(std430, binding = 2) buffer Commands { DrawCommand commands[]; };
layout(location = 0) uniform mat4 clip_from_model;
layout(location = 1) uniform ivec2 window;
layout(location = 2) uniform uint first_command;
layout(location = 3) uniform uint command_count;

void main() {
  if (gl_GlobalInvocationID.x >= command_count) return;
  uint number = first_command + gl_GlobalInvocationID.x;
  uint box = commands[number].first_index / kIndicesPerCluster * 6u;
  vec3 low = vec3(1e30), high = vec3(-1e30);
  for (uint corner = 0u; corner < 8u; ++corner) {
    vec3 position = vec3(boxes[box + ((corner & 1u) != 0u ? 3u : 0u)], boxes[box + ((corner & 2u) != 0u ? 4u : 1u)],
                         boxes[box + ((corner & 4u) != 0u ? 5u : 2u)]);
    vec4 clip = clip_from_model * vec4(position, 1.0);
    if (clip.w <= 0.0 || clip.z < -clip.w) return;  // the box crosses the near plane
    vec3 ndc = clip.xyz / clip.w;
    low = min(low, ndc);
    high = max(high, ndc);
  }
  float nearest = low.z * 0.5 + 0.5 - kClusterMarginDepth;
  vec2 size = vec2(window);
  vec2 cell = vec2(float(kDepthCell));
  ivec2 last = (window + int(kDepthCell) - 1) / int(kDepthCell) - 1;
  // Clamp before the cast, because a box near the eye may extend beyond the range of an int.
  vec2 limit = vec2(last);
  ivec2 from = ivec2(clamp(floor(((low.xy * 0.5 + 0.5) * size - kClusterMarginPx) / cell), vec2(0.0), limit));
  ivec2 to = ivec2(clamp(floor(((high.xy * 0.5 + 0.5) * size + kClusterMarginPx) / cell), vec2(0.0), limit));
  for (int y = from.y; y <= to.y; ++y)
    for (int x = from.x; x <= to.x; ++x)
      if (cells[y * (last.x + 1) + x] >= nearest) return;
  commands[number].instance_count = 0u;
}
