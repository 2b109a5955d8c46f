#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"

namespace strata {
struct Camera;
}
namespace strata::mesh {
class SearchTree;
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

// A layer in the form for queries: metadata and a consistent snapshot of its tiles.
struct LayerView {
  Layer layer;
  TileMirror::Snapshot snapshot;
};

struct LayerValue {
  std::string layer;  // slug
  bool valid = false;
  double value = 0;
};

struct SurfacePoint {
  bool hit = false;
  glm::dvec3 position{0};  // world
  glm::vec3 normal{0};
  double distance = 0;  // from the given point, or along the ray; model units
  glm::vec2 uv{0};
  std::vector<LayerValue> values;
};

// The value at a texture coordinate: that of the texel that contains it (nearest), as on the
// screen.
LayerValue value_at(const LayerView& view, glm::vec2 uv);

SurfacePoint nearest_point(const mesh::SearchTree& tree, const glm::dvec3& origin,
                           const glm::dvec3& world_point, const std::vector<LayerView>& layers);
SurfacePoint pick(const mesh::SearchTree& tree, const glm::dvec3& origin, const Camera& camera,
                  double x, double y, const std::vector<LayerView>& layers);
// The layer's key at the center of each cell of a grid over the camera's window, row by row from
// the top left; nothing where there is no surface or nothing is painted. For a layer of
// non-negative integers.
std::vector<std::optional<std::uint32_t>> seen_keys(const mesh::SearchTree& tree,
                                                    const glm::dvec3& origin, const Camera& camera,
                                                    int columns, int rows, const LayerView& layer);
// Returns a byte for each cell of such a grid: 1 where the camera sees a texel of the selection at
// the cell's center. `selection` null: any surface. Counts a step for each cell in the current
// question.
std::vector<std::uint8_t> seen_selection(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                         const Camera& camera, int columns, int rows,
                                         const mesh::SurfaceMap& map,
                                         const std::vector<std::uint64_t>* selection);

}  // namespace strata::query
