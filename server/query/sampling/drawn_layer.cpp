#include "query/sampling/drawn_layer.h"

#include <algorithm>

namespace strata::query {
namespace {

// Returns the share of the surface that the color of a value covers, from 0 to 1.
double cover_of(const DrawnLayer& layer, double value, const Rgba& color) {
  const Palette::Point* point = point_of(*layer.palette, value);
  if (point && point->pattern == Pattern::outline) return 0;
  return color[3] / 255.0 * std::clamp(layer.opacity, 0.0, 1.0);
}

}  // namespace

glm::dvec3 drawn_over(const DrawnLayer& layer, const glm::dvec3& below, std::uint32_t bits) {
  const double value = decode_value(layer.type, bits);
  const Rgba color = color_of(*layer.palette, value);
  const glm::dvec3 ink(color[0], color[1], color[2]);
  const double cover = cover_of(layer, value, color);
  switch (layer.blend) {
    case LayerBlend::normal: break;
    case LayerBlend::multiply: return glm::mix(below, below * ink / 255.0, cover);
    case LayerBlend::screen: return glm::mix(below, below + ink - below * ink / 255.0, cover);
  }
  return glm::mix(below, ink, cover);
}

}  // namespace strata::query
