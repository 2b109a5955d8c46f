#version 450 core
#include "shared/pages.h"
// Packs whole tiles for read-back. Each tile has 512 words of valid bits, and then the values, both
// row by row. One thread processes 32 texels. TEXEL_BYTES is 1, 2 or 4.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Pages { uint pages[]; };
layout(std430, binding = 1) writeonly buffer Packed { uint packed_words[]; };
layout(binding = 0) uniform usampler2DArray values;
layout(binding = 1) uniform usampler2DArray valid;
layout(location = 0) uniform uint first_page;

const uint kRunsPerTile = 512u;
const uint kWordsPerRun = 8u * TEXEL_BYTES;
const uint kWordsPerTile = kRunsPerTile * (1u + kWordsPerRun);

void main() {
  uint tile = gl_WorkGroupID.y;
  uint run = gl_GlobalInvocationID.x;
  ivec3 source = page_origin(pages[first_page + tile]) + ivec3((run % 4u) * 32u, run / 4u, 0);
  uint bits = 0u;
  for (int x = 0; x < 32; ++x)
    if (texelFetch(valid, source + ivec3(x, 0, 0), 0).r != 0u) bits |= 1u << x;
  uint base = (first_page + tile) * kWordsPerTile;
  packed_words[base + run] = bits;
  uint out_word = base + kRunsPerTile + run * kWordsPerRun;
  const int kTexelsPerWord = 4 / TEXEL_BYTES;
  for (int word = 0; word < int(kWordsPerRun); ++word) {
    uint packed_texels = 0u;
    for (int i = 0; i < kTexelsPerWord; ++i) {
      uint texel = texelFetch(values, source + ivec3(word * kTexelsPerWord + i, 0, 0), 0).r;
      packed_texels |= texel << (i * 8 * TEXEL_BYTES);
    }
    packed_words[out_word + uint(word)] = packed_texels;
  }
}
