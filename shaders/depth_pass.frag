#version 450 core
#include "shared/mesh.h"
#ifdef SECTION
layout(std140, binding = 0) uniform MeshBlock { MeshUniforms mesh; };
#endif

void main() {
#ifdef SECTION
  gl_FragDepth = marked_depth(gl_FragCoord.z, !gl_FrontFacing && mesh.eye_is_cut_away != 0u);
#endif
}
