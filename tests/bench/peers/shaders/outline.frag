#version 450 core
// Selects texels that are not covered but have a covered neighbor.
layout(binding = 0) uniform usampler2D coverage;
layout(location = 0) out uint outline;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy), last = textureSize(coverage, 0) - 1;
  bool beside = false;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      beside = beside || texelFetch(coverage, clamp(texel + ivec2(x, y), ivec2(0), last), 0).r != 0u;
  outline = beside && texelFetch(coverage, texel, 0).r == 0u ? 1u : 0u;
}
