#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/scene/camera.h"
#include "mesh/surface/search_tree.h"
#include "mesh/texels/surface_map.h"

namespace strata::query {

// A layer as a query sees it: metadata and a consistent snapshot of its tiles.
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
  double distance = 0;  // from the asked point, or along the ray; model units
  glm::vec2 uv{0};
  std::vector<LayerValue> values;
};

// Value at a texture coordinate: the texel that holds it (nearest), as the screen shows it.
LayerValue value_at(const LayerView& view, glm::vec2 uv);

SurfacePoint nearest_point(const mesh::SearchTree& tree, const glm::dvec3& origin,
                           const glm::dvec3& world_point, const std::vector<LayerView>& layers);
SurfacePoint pick(const mesh::SearchTree& tree, const glm::dvec3& origin, const Camera& camera,
                  double x, double y, const std::vector<LayerView>& layers);
// What the layer has in the middle of each cell of a grid over the camera's window, row by row from
// the top left; nothing where there is no surface or nothing is painted. Of a layer of whole
// numbers that are not negative.
std::vector<std::optional<std::uint32_t>> seen_keys(const mesh::SearchTree& tree,
                                                    const glm::dvec3& origin, const Camera& camera,
                                                    int columns, int rows, const LayerView& layer);

}  // namespace strata::query
