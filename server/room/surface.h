#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/error.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"

namespace strata::mesh {
struct Geometry;
class SearchTree;
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::room {

struct PlacedValue {
  glm::dvec3 world{0};
  std::uint32_t bits = 0;  // of the layer's type
  int line = 0;            // of the text that they came from
};
using ValueAt = std::function<std::optional<std::uint32_t>(const glm::dvec3& world)>;

// What an open model is, whatever its layers hold. Thread-safe. The tree is built and a map baked
// when first asked for, so call from a worker thread.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual std::shared_ptr<const mesh::Geometry> geometry() const = 0;
  virtual std::shared_ptr<const mesh::SearchTree> search_tree() = 0;
  virtual Result<std::shared_ptr<const mesh::SurfaceMap>> map(int resolution) = 0;
  // What maps and measurements paint (query/maps), for an ImportEdit `over` the layer.
  // Around the surface point nearest to each place, which may lie `tolerance` from it (model
  // units): refused otherwise (invalid).
  virtual Result<TileMap> point_splats(const Layer& layer, const std::vector<PlacedValue>& values,
                                       double radius, double tolerance) = 0;
  // The surface that is seen first along a direction, without perspective, by a function of its
  // place in the world.
  virtual Result<TileMap> project(const Layer& layer, const glm::dvec3& direction,
                                  const ValueAt& value_at) = 0;
};

}  // namespace strata::room
