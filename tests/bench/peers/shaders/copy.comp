#version 450 core
// Copies memory at full bandwidth, to measure the lower limit of an edit's time.
layout(local_size_x = 256) in;
layout(std430, binding = 0) readonly buffer From { uvec4 from[]; };
layout(std430, binding = 1) writeonly buffer To { uvec4 to[]; };

void main() { to[gl_GlobalInvocationID.x] = from[gl_GlobalInvocationID.x]; }
