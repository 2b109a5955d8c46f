#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include "domain/layers/layer_blend.h"
#include "domain/layers/palette.h"
#include "domain/layers/tile_mirror.h"

namespace strata::query {

// A layer with its drawing style.
struct DrawnLayer {
  TileMap tiles;
  int resolution = 0;
  ValueType type = ValueType::u8;
  // colors by the value of the texel, never by a column
  std::shared_ptr<const Palette> palette;
  double opacity = 1;
  LayerBlend blend = LayerBlend::normal;
};

// Returns the color of a texel over the color `below`, as in shade_pass.frag. Colors are red, green
// and blue from 0 to 255. Hatches and dots have the full color of their class, and an outline has
// no color.
glm::dvec3 drawn_over(const DrawnLayer& layer, const glm::dvec3& below, std::uint32_t bits);

}  // namespace strata::query
