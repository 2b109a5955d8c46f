#version 450 core
// Copies a frame. The blend function adds a share of the frame to a sum (render/view/accumulation).
layout(binding = 0) uniform sampler2D picture;
layout(location = 0) out vec4 color;

void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }
