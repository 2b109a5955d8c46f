#version 450 core
layout(location = 0) in vec4 projected;
layout(location = 0) out uint covered;
void main() { covered = 1u; }
