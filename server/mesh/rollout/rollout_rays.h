#pragma once

#include <optional>

#include "mesh/rollout/rollout_sheet.h"
#include "mesh/surface/search_tree.h"

namespace strata::mesh {

// The point of the model at a point of a sheet.
struct RolloutHit {
  RolloutSheet::SurfacePlace place;
  SearchTree::Hit hit;
};

// The rays of one side of a sheet (DevelopedSurface::ray): from the outside to the axis, or from
// the axis to the outside. `tree` and `sheet` are of `geometry`, and all three must outlive this
// object. Thread-safe.
class RolloutRays {
 public:
  RolloutRays(const SearchTree& tree, const Geometry& geometry, const RolloutSheet& sheet);

  const RolloutSheet& sheet() const { return sheet_; }
  // Returns the first surface on the ray through a point of the sheet. Returns nullopt outside the
  // sheet, without a surface, and if the first surface is seen from its back.
  std::optional<RolloutHit> cast(const glm::dvec2& on_sheet) const;
  // Returns whether a point of the surface, in model space, is the first surface on its ray and is
  // seen from its front. `place` is the place of the point.
  bool sees(const glm::vec3& position, const RolloutSheet::SurfacePlace& place) const;

 private:
  struct Ray {
    glm::dvec3 start{0}, direction{0};  // in model space
    double length = 0;
  };
  Ray ray_at(const RolloutSheet::SurfacePlace& place) const;

  const SearchTree& tree_;
  const glm::dvec3 origin_;
  const RolloutSheet& sheet_;
  double reach_ = 0;
};

}  // namespace strata::mesh
