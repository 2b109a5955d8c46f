#version 450 core
#include "shared/marks.h"
// A rectangle around each segment, two triangles.
layout(std140, binding = 0) uniform MarkBlock { MarkUniforms marks; };
layout(std430, binding = 0) readonly buffer SegmentBlock { MarkSegment segments[]; };
layout(location = 0) out vec2 place;  // pixels
layout(location = 1) flat out vec4 ends;
layout(location = 2) flat out vec2 widths;
layout(location = 3) flat out vec4 mark_color;

void main() {
  MarkSegment segment = segments[gl_VertexID / 6];
  int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
  bool at_end = (corner & 1) != 0;
  vec2 along = segment.to.xy - segment.from.xy;
  along = dot(along, along) > 1e-12 ? normalize(along) : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x) * ((corner & 2) != 0 ? 1.0 : -1.0);
  float reach = segment.from.w + segment.to.w + 1.0;
  vec4 end = at_end ? segment.to : segment.from;
  place = end.xy + ((at_end ? along : -along) + across) * reach;
  ends = vec4(segment.from.xy, segment.to.xy);
  widths = vec2(segment.from.w, segment.to.w);
  mark_color = segment.color;
  gl_Position = vec4(place / marks.size.xy * 2.0 - 1.0, end.z * 2.0 - 1.0, 1.0);
}
