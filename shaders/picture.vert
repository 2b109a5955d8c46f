#version 450 core
// Draws one triangle over the whole frame at the farthest depth. A depth test for "greater" then
// rejects the background.
void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 4.0 - 1.0;
  gl_Position = vec4(corner, 1.0, 1.0);
}
