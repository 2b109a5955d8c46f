#version 450 core
#include "shared/shade.h"
// Draws the gradient of the background from the top to the bottom of the frame.
layout(std140, binding = 0) uniform ShadeUniformBlock { ShadeUniforms shade; };
layout(location = 0) out vec4 picture;

void main() {
  float down = 1.0 - gl_FragCoord.y / float(shade.picture_height);
  picture = vec4(mix(shade.background_top.rgb, shade.background_bottom.rgb, down), 1.0);
}
