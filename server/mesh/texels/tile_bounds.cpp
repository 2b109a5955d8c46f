#include "mesh/texels/tile_bounds.h"

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <limits>

#include "domain/layers/tile.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {
namespace {

// A triangle can own a texel next to it, and the gutter is 2 texels wide. Vertices are rounded.
constexpr float kMarginTexels = 4;

struct Box {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
};

}  // namespace

std::vector<BoundingSphere> bound_tiles(const Geometry& geometry, int resolution) {
  const int per_side = resolution / kTileSize;
  std::vector<Box> boxes(static_cast<std::size_t>(per_side) * per_side);
  const float tiles = static_cast<float>(per_side), margin = kMarginTexels / kTileSize;
  const auto tile_at = [&](float place) {
    return static_cast<int>(std::clamp(place, 0.0f, tiles - 1));
  };
  for (std::size_t first = 0; first + 2 < geometry.indices.size(); first += 3) {
    std::array<const Vertex*, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = &geometry.vertices[geometry.indices[first + k]];
    glm::vec2 low = corners[0]->uv, high = low;
    for (const Vertex* corner : corners) {
      low = glm::min(low, corner->uv);
      high = glm::max(high, corner->uv);
    }
    for (int y = tile_at(low.y * tiles - margin); y <= tile_at(high.y * tiles + margin); ++y)
      for (int x = tile_at(low.x * tiles - margin); x <= tile_at(high.x * tiles + margin); ++x) {
        Box& box = boxes[static_cast<std::size_t>(y) * per_side + x];
        for (const Vertex* corner : corners) {
          box.low = glm::min(box.low, corner->position);
          box.high = glm::max(box.high, corner->position);
        }
      }
  }
  std::vector<BoundingSphere> bounds(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto& [low, high] = boxes[i];
    // The distance from the center is rounded.
    if (low.x <= high.x)
      bounds[i] = {(low + high) * 0.5f, glm::length(high - low) * 0.5f * 1.0001f};
  }
  return bounds;
}

}  // namespace strata::mesh
