#version 450 core
layout(location = 5) uniform uint value;
layout(location = 6) uniform uint edit_number;
layout(binding = 0) uniform usampler2D outline;
layout(binding = 1) uniform usampler2D edited;
layout(location = 0) out uint data;
layout(location = 1) out uint mask;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy), last = textureSize(outline, 0) - 1;
  if (texelFetch(outline, texel, 0).r == 0u) discard;
  bool beside = false;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      beside = beside || texelFetch(edited, clamp(texel + ivec2(x, y), ivec2(0), last), 0).r == edit_number;
  if (!beside) discard;
  data = value;
  mask = 1u;
}
