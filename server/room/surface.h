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
struct FitRequest;
struct FittedSheet;
struct Geometry;
class SearchTree;
struct SurfaceMap;
struct TexelGraph;
}  // namespace strata::mesh

namespace strata::room {

struct PlacedValue {
  glm::dvec3 world{0};
  std::uint32_t bits = 0;  // of the layer's type
  int line = 0;            // line number in the imported text
};
using ValueAt = std::function<std::optional<std::uint32_t>(const glm::dvec3& world)>;

// The shape of an open model, without the content of its layers. The tree and the maps are built on
// first use, so call from a worker thread. Thread-safe.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual std::shared_ptr<const mesh::Geometry> geometry() const = 0;
  virtual std::shared_ptr<const mesh::SearchTree> search_tree() = 0;
  virtual Result<std::shared_ptr<const mesh::SurfaceMap>> map(int resolution) = 0;
  // Returns the connections between the texels of the map of a resolution.
  virtual Result<std::shared_ptr<const mesh::TexelGraph>> graph(int resolution) = 0;
  // Returns the color of each texel of the map of a resolution, after up to several seconds
  // (query/sampling/texel_appearance.h): the colors of one surface image without its opacity, or
  // without `image`, those of the scan with the images that are visible by default. Returns an
  // `invalid` error without a field if there are no colors, and at `look` for an image that does
  // not exist.
  virtual Result<std::shared_ptr<const std::vector<std::uint32_t>>> colors(
      int resolution, std::optional<SurfaceImageId> image) = 0;
  // Returns the sheet of a rollout in the up direction of the model (mesh::fit_sheet). Checks the
  // current question.
  virtual Result<std::shared_ptr<const mesh::FittedSheet>> sheet(
      const mesh::FitRequest& request, const std::optional<double>& cut) = 0;
  // The next two functions paint maps and measurements (query/maps) for an ImportEdit with `over`.
  // `point_splats` paints around the surface point nearest to each position. Returns an `invalid`
  // error if a surface point is farther away than `tolerance` (model units).
  virtual Result<TileMap> point_splats(const Layer& layer, const std::vector<PlacedValue>& values,
                                       double radius, double tolerance) = 0;
  // Paints the surface that is first visible along a direction, without perspective. `value_at`
  // returns the value for a position in the world.
  virtual Result<TileMap> project(const Layer& layer, const glm::dvec3& direction,
                                  const ValueAt& value_at) = 0;
};

}  // namespace strata::room
