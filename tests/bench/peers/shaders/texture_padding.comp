#version 450 core
// The algorithm of texture_padding.frag as a compute pass.
layout(local_size_x = 16, local_size_y = 16) in;
layout(location = 5) uniform uint value;
layout(location = 6) uniform uint edit_number;
layout(binding = 0) uniform usampler2D outline;
layout(binding = 1) uniform usampler2D edited;
layout(r8ui, binding = 0) uniform writeonly uimage2D data;
layout(r8ui, binding = 1) uniform writeonly uimage2D mask;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy), last = textureSize(outline, 0) - 1;
  if (texelFetch(outline, texel, 0).r == 0u) return;
  bool beside = false;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      beside = beside || texelFetch(edited, clamp(texel + ivec2(x, y), ivec2(0), last), 0).r == edit_number;
  if (!beside) return;
  imageStore(data, texel, uvec4(value));
  imageStore(mask, texel, uvec4(1u));
}
