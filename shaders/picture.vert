#version 450 core
// One triangle over the whole picture at the farthest depth: a depth test for "greater" leaves out
// the background.
void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 4.0 - 1.0;
  gl_Position = vec4(corner, 1.0, 1.0);
}
