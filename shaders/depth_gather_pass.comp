#version 450 core
// Reads the depths at a list of pixels.
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D depth;
layout(std430, binding = 0) readonly buffer Pixels { ivec2 pixels[]; };
layout(std430, binding = 1) writeonly buffer Depths { float depths[]; };
layout(location = 0) uniform uint count;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) depths[i] = texelFetch(depth, pixels[i], 0).r;
}
