#include "query/sampling/vertex_colors.h"

#include <algorithm>
#include <cmath>

#include "domain/layers/texel_lookup.h"
#include "domain/people/question.h"
#include "mesh/texture/texture_sampler.h"

namespace strata::query {
namespace {

// number of vertices between two checks of the current question
constexpr std::size_t kVerticesAtOnce = 1u << 16;

using Rgb = std::array<std::uint8_t, 3>;

Rgb scan_color(std::uint32_t color) {
  return {static_cast<std::uint8_t>(color), static_cast<std::uint8_t>(color >> 8),
          static_cast<std::uint8_t>(color >> 16)};
}

glm::dvec3 numbers(const Rgb& color) { return {color[0], color[1], color[2]}; }

Rgb rounded(const glm::dvec3& color) {
  Rgb out;
  for (int i = 0; i < 3; ++i)
    out[i] = static_cast<std::uint8_t>(std::lround(std::clamp(color[i], 0.0, 255.0)));
  return out;
}

}  // namespace

void VertexColors::add_photo(const Picture& photo, double opacity) {
  const std::vector<mesh::Vertex>& vertices = geometry_->vertices;
  if (base_.empty()) {
    base_.reserve(vertices.size());
    for (const mesh::Vertex& vertex : vertices) base_.push_back(scan_color(vertex.color));
  }
  const mesh::TextureSampler sampler(photo);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (i % kVerticesAtOnce == 0) check_question();
    const glm::dvec4 color(
        sampler.sample_with_alpha(vertices[i].uv, mesh::Wrap::clamp, mesh::Wrap::clamp));
    base_[i] = rounded(glm::mix(numbers(base_[i]), glm::dvec3(color),
                                color.a / 255.0 * std::clamp(opacity, 0.0, 1.0)));
  }
}

Rgb VertexColors::at(std::span<const std::uint32_t> vertices) const {
  if (vertices.empty()) return {};
  const mesh::Geometry& mesh = *geometry_;
  glm::dvec3 color = numbers(base_.empty() ? scan_color(mesh.vertices[vertices.front()].color)
                                           : base_[vertices.front()]);
  for (const DrawnLayer& layer : layers_) {
    std::optional<std::uint32_t> bits;
    for (const std::uint32_t vertex : vertices)
      if (!bits) bits = bits_at(layer.tiles, layer.resolution, mesh.vertices[vertex].uv);
    if (bits) color = drawn_over(layer, color, *bits);
  }
  return rounded(color);
}

}  // namespace strata::query
