#version 450 core
// Draws the mesh at its texture coordinates. Interpolates the clip coordinates of the scene's
// camera for the projection.
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 0) uniform mat4 clip_from_model;
layout(location = 0) out vec4 projected;

void main() {
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
  projected = clip_from_model * vec4(position, 1.0);
}
