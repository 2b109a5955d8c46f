#pragma once

#include <memory>
#include <vector>

#include "query/sampling/texel_appearance.h"
#include "room/open/open_room.h"
#include "room/surface.h"

namespace strata::room {

class OpenRoom::SurfacePart final : public Surface {
 public:
  explicit SurfacePart(OpenRoom& room) : room_(room) {}
  std::shared_ptr<const mesh::Geometry> geometry() const override;
  std::shared_ptr<const mesh::SearchTree> search_tree() override;
  Result<std::shared_ptr<const mesh::SurfaceMap>> map(int resolution) override;
  Result<std::shared_ptr<const mesh::TexelGraph>> graph(int resolution) override;
  Result<std::shared_ptr<const query::TexelAppearance>> colors(
      int resolution, std::optional<SurfaceImageId> image) override;
  Result<std::shared_ptr<const mesh::FittedSheet>> sheet(const mesh::FitRequest& request,
                                                         const std::optional<double>& cut) override;
  Result<TileMap> point_splats(const Layer& layer, const std::vector<PlacedValue>& values,
                               double radius, double tolerance) override;
  Result<TileMap> project(const Layer& layer, const glm::dvec3& direction,
                          const ValueAt& value_at) override;

 private:
  OpenRoom& room_;
};

}  // namespace strata::room
