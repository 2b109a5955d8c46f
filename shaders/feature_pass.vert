#version 450 core
#include "shared/features.h"
// Makes a rectangle of two triangles around each visible segment.
layout(std140, binding = 0) uniform FeatureBlock { FeatureUniforms marks; };
layout(std430, binding = 0) readonly buffer SegmentBlock { FeatureSegment segments[]; };
layout(location = 0) out vec2 place;  // in pixels
layout(location = 1) flat out vec4 ends;
layout(location = 2) flat out float mark_half_width;
layout(location = 3) flat out vec4 mark_color;
layout(location = 4) flat out uvec2 places;

const vec3 kCasing = vec3(1.0);

void main() {
  FeatureSegment segment = segments[gl_VertexID / 6];
  int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
  bool at_end = (corner & 1) != 0;
  vec2 along = segment.to.xy - segment.from.xy;
  along = dot(along, along) > 1e-12 ? normalize(along) : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x) * ((corner & 2) != 0 ? 1.0 : -1.0);
  float half_width = segment.from.w + (marks.size.z == 0.0 ? segment.to.w : 0.0);
  float reach = half_width + 1.0;
  vec4 end = at_end ? segment.to : segment.from;
  place = end.xy + ((at_end ? along : -along) + across) * reach;
  ends = vec4(segment.from.xy, segment.to.xy);
  mark_half_width = half_width;
  mark_color = marks.size.z == 0.0 ? vec4(kCasing, segment.color.a) : segment.color;
  places = uvec2(segment.place_count, segment.shown);
  gl_Position = segment.shown == 0u ? vec4(0.0, 0.0, 0.0, 1.0) : vec4(place / marks.size.xy * 2.0 - 1.0, 0.0, 1.0);
}
