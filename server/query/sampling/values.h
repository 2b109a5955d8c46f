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

// A layer for queries: its metadata and a consistent snapshot of its tiles.
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
  double distance = 0;  // distance from the given point, or along the ray, in model units
  glm::vec2 uv{0};
  std::vector<LayerValue> values;
};

// Returns the value at a texture coordinate: the value of the texel that contains it (nearest), as
// on the screen.
LayerValue value_at(const LayerView& view, glm::vec2 uv);

SurfacePoint nearest_point(const mesh::SearchTree& tree, const glm::dvec3& origin,
                           const glm::dvec3& world_point, const std::vector<LayerView>& layers);
SurfacePoint pick(const mesh::SearchTree& tree, const glm::dvec3& origin, const Camera& camera,
                  double x, double y, const std::vector<LayerView>& layers);
// Returns the key at the center of each cell of a grid over the window of the camera, row by row
// from the top left. A cell without a surface or without paint has no key. The layer must store
// integers. The key of a negative number is its value as a 32-bit integer.
std::vector<std::optional<std::uint32_t>> seen_keys(const mesh::SearchTree& tree,
                                                    const glm::dvec3& origin, const Camera& camera,
                                                    int columns, int rows, const LayerView& layer);
// Returns a picture with one pixel for each cell of such a grid: the surface in the colors of the
// layer's palette, gray where it has no value, lit from the camera, and transparent where there is
// none. Red, green, blue and alpha. Counts one step of the current question for each cell.
std::vector<std::uint8_t> picture_of_values(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                            const Camera& camera, int columns, int rows,
                                            const LayerView& layer);
// Returns one byte for each cell of such a grid: 1 if the camera sees a texel of the selection at
// the center of the cell. A null `selection` selects the whole surface. Counts one step of the
// current question for each cell.
std::vector<std::uint8_t> seen_selection(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                         const Camera& camera, int columns, int rows,
                                         const mesh::SurfaceMap& map,
                                         const std::vector<std::uint64_t>* selection);

}  // namespace strata::query
