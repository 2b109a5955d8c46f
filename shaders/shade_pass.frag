#version 450 core
#include "shared/cut.h"
#include "shared/mesh.h"
#include "shared/pages.h"
#include "shared/shade.h"
// Colors the surface of a frame with its lit base color and the layers from bottom to top. Layers
// are sampled by texture coordinate. CHUNK_COUNT (0…6) pairs of value and valid textures are bound.
// Another draw handles texels whose chunk is not bound. LAYERS, if defined, lists the layers, each
// as SHADE_LAYER(index, mode, type, bits of the units that may contain it, kind of its patterns,
// blending mode). Each layer then gets specialized code, because software renderers run both sides
// of each branch. Without LAYERS, a loop runs over layer_count.
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
// The first draw replaces the content. Later draws (OVER) output picture + kept * content.
layout(location = 0, index = 0) out vec4 picture;
#ifdef OVER
layout(location = 0, index = 1) out vec4 kept;
#endif

// The result of a draw is added + kept * content.
struct Color {
  vec3 added, kept;
};

const uint kTypeU8 = 0u, kTypeU16 = 1u, kTypeU32 = 2u, kTypeI8 = 3u, kTypeI16 = 4u, kTypeI32 = 5u, kTypeF16 = 6u, kTypeF32 = 7u;

float number_of(uint bits, uint type) {
  if (type <= kTypeU32) return float(bits);
  if (type == kTypeI8) return float(int(bits << 24) >> 24);
  if (type == kTypeI16) return float(int(bits << 16) >> 16);
  if (type == kTypeI32) return float(int(bits));
  if (type == kTypeF16) return unpackHalf2x16(bits).x;
  return uintBitsToFloat(bits);
}

// Returns the key for the generated color of an unlisted value: its integer value, as 32 bits.
uint key_of(uint bits, uint type) {
  if (type <= kTypeU32) return bits;
  if (type == kTypeI8) return uint(int(bits << 24) >> 24);
  if (type == kTypeI16) return uint(int(bits << 16) >> 16);
  if (type == kTypeI32) return bits;
  return uint(int(number_of(bits, type)));
}

// Computes the same color as strata::generated_color.
vec4 generated_color(uint key) {
  uint h = key * 2654435761u;
  float hue = float(h >> 8) / 16777216.0 * 6.0;
  float saturation = 0.55 + 0.25 * float(h & 0xffu) / 255.0;
  vec3 k = mod(vec3(5.0, 3.0, 1.0) + hue, 6.0);
  return vec4(0.85 - 0.85 * saturation * clamp(min(k, 4.0 - k), 0.0, 1.0), 1.0);
}

// The color and pattern of a value.
struct Ink {
  vec4 color;
  uint pattern;
};

Ink ink_of(PalettePoint point) { return Ink(unpackUnorm4x8(point.color), point.pattern); }

Ink step_ink(ShadeLayer layer, float value) {
  uint low = 0u, high = layer.point_count;  // the first point above the value is in [low, high]
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (uintBitsToFloat(points[layer.points + middle].key) <= value) low = middle + 1u;
    else high = middle;
  }
  return ink_of(points[layer.points + max(low, 1u) - 1u]);
}

Ink category_ink(ShadeLayer layer, uint type, uint bits) {
  uint low = 0u, high = layer.point_count;
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (points[layer.points + middle].key < bits) low = middle + 1u;
    else high = middle;
  }
  if (low < layer.point_count && points[layer.points + low].key == bits) return ink_of(points[layer.points + low]);
  return Ink(layer.has_others != 0u ? unpackUnorm4x8(layer.others) : generated_color(key_of(bits, type)), kPatternSolid);
}

vec4 linear_color(ShadeLayer layer, float value) {
  float position = clamp((value - layer.palette_min) / (layer.palette_max - layer.palette_min), 0.0, 1.0);
  return texelFetch(palettes, ivec2(int(position * float(kPaletteWidth - 1u) + 0.5), int(layer.row)), 0);
}

Ink ink_of(ShadeLayer layer, uint mode, uint type, uint bits) {
  if (mode == kPaletteCategorical) return category_ink(layer, type, bits);
  float value = number_of(bits, type);
  if (mode == kPaletteStep) return step_ink(layer, clamp(value, layer.palette_min, layer.palette_max));
  return Ink(linear_color(layer, value), kPatternSolid);
}

#if CHUNK_COUNT > 0
// Returns x: the bits of the texel, y: 1 if it has a value.
uvec2 texel_of(ShadeLayer layer, uint units, uint q) {
  uint shift = 16u - layer.resolution_bits;
  uvec2 texel = uvec2(q & 0xffffu, q >> 16) >> shift;
  uvec2 tile = texel / kTileTexels;
  uint tiles_per_side = 1u << (layer.resolution_bits - 7u);
  uint page = page_tables[layer.table + tile.y * tiles_per_side + tile.x];
  if (page == kNoPage) return uvec2(0u);
  uint chunk = page >> kPageChunkShift;
  uint unit = ((chunk < 8u ? layer.units_low : layer.units_high) >> ((chunk & 7u) * 4u)) & 15u;
  ivec3 place = page_origin(page) + ivec3(texel % kTileTexels, 0);
  uvec2 found = uvec2(0u);
  for (int i = 0; i < CHUNK_COUNT; ++i) {
    if ((units >> i & 1u) != 0u && unit == uint(i)) {
      found = uvec2(texelFetch(chunk_values[i], place, 0).r, texelFetch(chunk_valid[i], place, 0).r);
    }
  }
  return found;
}

// Returns the share of a pixel that hatch or dots cover, 0…1.
float pattern_cover(uint pattern) {
  float spacing = unpackHalf2x16(pattern >> 16).x / shade.patterns.z;
  if (spacing <= 0.0) spacing = kPatternPixels * shade.patterns.w;
  spacing *= exp2(max(0.0, ceil(log2(kPatternClosestPixels * shade.patterns.w / spacing))));
  float angle = float(pattern >> 2 & 0x3fffu) / 16384.0 * 3.14159265;
  vec2 along = vec2(cos(angle), sin(angle));
  vec2 from = gl_FragCoord.xy - shade.patterns.xy;
  vec2 place = vec2(dot(from, along), dot(from, vec2(-along.y, along.x))) / spacing;
  vec2 middle = (place - floor(place) - 0.5) * spacing;  // pixels from the center of the cell
  float inside = (pattern & 3u) == kPatternDots ? kDotRadius * spacing - length(middle) : kHatchShare * 0.5 * spacing - abs(middle.y);
  return clamp(inside + 0.5, 0.0, 1.0);
}

bool same_texel(ShadeLayer layer, uint units, ivec2 pixel, uint bits) {
  uint q = texelFetch(surface_uv, clamp(pixel, ivec2(0), textureSize(surface_uv, 0) - 1), 0).r;
  return q != kBackground && texel_of(layer, units, q) == uvec2(bits, 1u);
}

float outline_cover(ShadeLayer layer, uint units, uint bits) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int width = max(1, int(kOutlinePixels * shade.patterns.w + 0.5));
  bool inside = same_texel(layer, units, pixel + ivec2(width, 0), bits) && same_texel(layer, units, pixel - ivec2(width, 0), bits) &&
                same_texel(layer, units, pixel + ivec2(0, width), bits) && same_texel(layer, units, pixel - ivec2(0, width), bits);
  return inside ? 0.0 : 1.0;
}

// Blends the layer over `color`.
void add_layer(inout Color color, ShadeLayer layer, uint mode, uint type, uint units, uint patterns, uint blend, uint q, float light) {
  uvec2 texel = texel_of(layer, units, q);
  if (texel.y == 0u) return;
  Ink ink = ink_of(layer, mode, type, texel.x);
  float cover = ink.color.a * layer.opacity;
  if (patterns != kNoPatterns && (ink.pattern & 3u) != kPatternSolid) {
    bool is_outline = (ink.pattern & 3u) == kPatternOutline, is_bare = patterns == kBarePatterns && !is_outline;
    float border = is_bare ? 0.0 : outline_cover(layer, units, texel.x);
    cover *= is_outline ? border : mix(is_bare ? 0.0 : kPatternGround, 1.0, max(border, pattern_cover(ink.pattern)));
  }
  vec3 lit = ink.color.rgb * light;
  // The colors below are already lit, so a multiplied ink is not lit again.
  vec3 kept = blend == kBlendMultiply ? 1.0 - cover + cover * ink.color.rgb : blend == kBlendScreen ? 1.0 - cover * lit : vec3(1.0 - cover);
  color.added = color.added * kept + (blend == kBlendMultiply ? vec3(0.0) : cover * lit);
  color.kept *= kept;
}
#endif

#ifdef CUT
// Returns whether a pixel shows the inside of a solid: the g-buffer then contains light but no
// texture coordinate. Pixels are clamped, so the border of the frame is not a border of the cut.
bool is_inside(ivec2 pixel) {
  pixel = clamp(pixel, ivec2(0), textureSize(surface_uv, 0) - 1);
  return texelFetch(surface_uv, pixel, 0).r == kBackground && texelFetch(surface_light, pixel, 0).a > 0.0;
}

vec3 cut_color(ivec2 pixel) {
  int width = max(1, int(kCutOutlinePixels * shade.patterns.w + 0.5));
  bool whole = is_inside(pixel + ivec2(width, 0)) && is_inside(pixel - ivec2(width, 0)) &&
               is_inside(pixel + ivec2(0, width)) && is_inside(pixel - ivec2(0, width));
  float ink = whole ? cut_hatch(gl_FragCoord.xy - shade.patterns.xy, shade.patterns.w) : 1.0;
  return mix(kCutGround, kCutInk, ink);
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(surface_light, pixel, 0);
#ifdef CUT
  if (texelFetch(surface_uv, pixel, 0).r == kBackground) surface.rgb = cut_color(pixel);
#endif
#ifdef OVER
  Color color = Color(vec3(0.0), vec3(1.0));
#else
  Color color = Color(surface.rgb, vec3(1.0));
#endif
#if CHUNK_COUNT > 0
  uint q = texelFetch(surface_uv, pixel, 0).r;
  if (q != kBackground) {  // not the inside of a solid
#ifdef LAYERS
#define SHADE_LAYER(index, mode, type, units, patterns, blend) \
  add_layer(color, layers[index], mode, type, units, patterns, blend, q, surface.a);
  LAYERS
#else
  for (uint i = 0u; i < shade.layer_count; ++i) {
    add_layer(color, layers[i], layers[i].mode, layers[i].type, 0x3fu, layers[i].patterns, layers[i].blend, q, surface.a);
  }
#endif
  }
#endif
  picture = vec4(color.added, 1.0);
#ifdef OVER
  kept = vec4(color.kept, 1.0);
#endif
}
