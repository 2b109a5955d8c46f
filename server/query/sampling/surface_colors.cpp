#include "query/sampling/surface_colors.h"

#include <algorithm>

#include "domain/layers/texel_lookup.h"
#include "mesh/texture/texture_sampler.h"

namespace strata::query {

glm::dvec3 SurfaceColors::at(const mesh::SearchTree::Hit& point) const {
  glm::dvec3 color(0);
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t scan =
        geometry_->vertices[geometry_->indices[std::size_t{3} * point.triangle + k]].color;
    color += static_cast<double>(point.barycentric[k]) *
             glm::dvec3(scan & 0xff, scan >> 8 & 0xff, scan >> 16 & 0xff);
  }
  for (const Photo& photo : photos_) {
    const glm::dvec4 pixel(mesh::TextureSampler(photo.picture)
                               .sample_with_alpha(point.uv, mesh::Wrap::clamp, mesh::Wrap::clamp));
    color =
        glm::mix(color, glm::dvec3(pixel), pixel.a / 255.0 * std::clamp(photo.opacity, 0.0, 1.0));
  }
  for (const DrawnLayer& layer : layers_)
    if (const auto bits = bits_at(layer.tiles, layer.resolution, point.uv))
      color = drawn_over(layer, color, *bits);
  return color;
}

}  // namespace strata::query
