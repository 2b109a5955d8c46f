#version 450 core
#include "shared/mesh.h"
#include "shared/pages.h"
#include "shared/shade.h"
// Colours a rectangle of a view: background, lit surface, and the layers bottom to top, sampled by texture coordinate.
// CHUNK_COUNT (0…6) pairs of value and valid textures are bound; a texel whose chunk is not bound is left to another dispatch.
// With SINGLE_LAYER the dispatch has one layer, which spares CPUs the lookup of its settings in each lane.
// MODES has the bits 1 (linear), 2 (step), 4 (categorical) of the palettes that occur: CPUs run every side of a branch.
layout(local_size_x = 16, local_size_y = 4) in;
layout(std140, binding = 0) uniform ShadeUniformBlock { ShadeUniforms shade; };
layout(std430, binding = 0) readonly buffer Tables { uint page_tables[]; };
layout(std430, binding = 1) readonly buffer Points { PalettePoint points[]; };
layout(std140, binding = 1) uniform LayerBlock { ShadeLayer layers[kMaxShadeLayers]; };
layout(binding = 0) uniform usampler2D surface_uv;
layout(binding = 1) uniform sampler2D surface_light;
layout(binding = 2) uniform sampler2D palettes;
#if CHUNK_COUNT > 0
layout(binding = 3) uniform usampler2DArray chunk_values[CHUNK_COUNT];
layout(binding = 9) uniform usampler2DArray chunk_valid[CHUNK_COUNT];
#endif
layout(rgba8, binding = 0) uniform image2D picture;

const uint kTypeU8 = 0u, kTypeU16 = 1u, kTypeU32 = 2u, kTypeI8 = 3u, kTypeI16 = 4u, kTypeI32 = 5u, kTypeF16 = 6u, kTypeF32 = 7u;

float number_of(uint bits, uint type) {
  if (type <= kTypeU32) return float(bits);
  if (type == kTypeI8) return float(int(bits << 24) >> 24);
  if (type == kTypeI16) return float(int(bits << 16) >> 16);
  if (type == kTypeI32) return float(int(bits));
  if (type == kTypeF16) return unpackHalf2x16(bits).x;
  return uintBitsToFloat(bits);
}

// Key that the generated colour of an unlisted value is made from: the whole number it holds, as 32 bits.
uint key_of(uint bits, uint type) {
  if (type <= kTypeU32) return bits;
  if (type == kTypeI8) return uint(int(bits << 24) >> 24);
  if (type == kTypeI16) return uint(int(bits << 16) >> 16);
  if (type == kTypeI32) return bits;
  return uint(int(number_of(bits, type)));
}

// The same as strata::generated_color.
vec4 generated_color(uint key) {
  uint h = key * 2654435761u;
  float hue = float(h >> 8) / 16777216.0 * 6.0;
  float saturation = 0.55 + 0.25 * float(h & 0xffu) / 255.0;
  vec3 k = mod(vec3(5.0, 3.0, 1.0) + hue, 6.0);
  return vec4(0.85 - 0.85 * saturation * clamp(min(k, 4.0 - k), 0.0, 1.0), 1.0);
}

vec4 step_color(ShadeLayer layer, float value) {
  uint low = 0u, high = layer.point_count;  // first point above the value lies in [low, high]
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (uintBitsToFloat(points[layer.points + middle].key) <= value) low = middle + 1u;
    else high = middle;
  }
  return unpackUnorm4x8(points[layer.points + max(low, 1u) - 1u].color);
}

vec4 category_color(ShadeLayer layer, uint bits) {
  uint low = 0u, high = layer.point_count;
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (points[layer.points + middle].key < bits) low = middle + 1u;
    else high = middle;
  }
  if (low < layer.point_count && points[layer.points + low].key == bits) {
    return unpackUnorm4x8(points[layer.points + low].color);
  }
  return generated_color(key_of(bits, layer.type));
}

vec4 linear_color(ShadeLayer layer, float value) {
  float position = clamp((value - layer.palette_min) / (layer.palette_max - layer.palette_min), 0.0, 1.0);
  return texelFetch(palettes, ivec2(int(position * float(kPaletteWidth - 1u) + 0.5), int(layer.row)), 0);
}

vec4 color_of(ShadeLayer layer, uint bits) {
#if MODES == 1
  return linear_color(layer, number_of(bits, layer.type));
#elif MODES == 2
  return step_color(layer, clamp(number_of(bits, layer.type), layer.palette_min, layer.palette_max));
#elif MODES == 4
  return category_color(layer, bits);
#else
  if (layer.mode == kPaletteCategorical) return category_color(layer, bits);
  float value = number_of(bits, layer.type);
  if (layer.mode == kPaletteStep) return step_color(layer, clamp(value, layer.palette_min, layer.palette_max));
  return linear_color(layer, value);
#endif
}

#if CHUNK_COUNT > 0
// x: bits, y: 1 when the texel holds a value.
uvec2 texel_of(ShadeLayer layer, uint q) {
  uint shift = 16u - layer.resolution_bits;
  uvec2 texel = uvec2(q & 0xffffu, q >> 16) >> shift;
  uvec2 tile = texel / kTileTexels;
  uint tiles_per_side = 1u << (layer.resolution_bits - 7u);
  uint page = page_tables[layer.table + tile.y * tiles_per_side + tile.x];
  if (page == kNoPage) return uvec2(0u);
  uint chunk = page >> kPageChunkShift;
  uint unit = ((chunk < 8u ? layer.units_low : layer.units_high) >> ((chunk & 7u) * 4u)) & 15u;
  if (unit == kNoChunkUnit) return uvec2(0u);
  ivec3 place = page_origin(page) + ivec3(texel % kTileTexels, 0);
#if CHUNK_COUNT == 1
  return uvec2(texelFetch(chunk_values[0], place, 0).r, texelFetch(chunk_valid[0], place, 0).r);
#else
  for (int i = 0; i < CHUNK_COUNT; ++i) {
    if (unit == uint(i)) return uvec2(texelFetch(chunk_values[i], place, 0).r, texelFetch(chunk_valid[i], place, 0).r);
  }
  return uvec2(0u);
#endif
}
#endif

void main() {
  if (gl_GlobalInvocationID.x >= shade.width || gl_GlobalInvocationID.y >= shade.height) return;
  ivec2 pixel = ivec2(shade.x, shade.y) + ivec2(gl_GlobalInvocationID.xy);          // origin top left, as the picture
  ivec2 source = ivec2(pixel.x, int(shade.picture_height) - 1 - pixel.y);            // origin lower left, as the g-buffer
  uint q = texelFetch(surface_uv, source, 0).r;
  vec4 surface = texelFetch(surface_light, source, 0);
  vec3 color = surface.rgb;
  if (shade.first_pass == 0u) {
    color = imageLoad(picture, pixel).rgb;
  } else if (q == kBackground) {
    float down = (float(pixel.y) + 0.5) / float(shade.picture_height);
    color = mix(shade.background_top.rgb, shade.background_bottom.rgb, down);
  }
#if CHUNK_COUNT > 0
  if (q != kBackground) {
#if SINGLE_LAYER
    const uint i = 0u;
    {
#else
    for (uint i = 0u; i < shade.layer_count; ++i) {
#endif
      ShadeLayer layer = layers[i];
      uvec2 texel = texel_of(layer, q);
      if (texel.y != 0u) {
        vec4 paint = color_of(layer, texel.x);
        color = mix(color, paint.rgb * surface.a, paint.a * layer.opacity);
      }
    }
  }
#endif
  imageStore(picture, pixel, vec4(color, 1.0));
}
