#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "mesh/rollout/fit_developed_surface.h"
#include "mesh/surface/search_tree.h"

namespace strata::mesh {

// The plane on which a surface is unrolled, in model units: x to the right and y up, as the viewer
// of the side sees them. Lengths and areas are those of the surface. The part between the angles
// `from` and `to` is unrolled. The middle angle is at x = 0, and there, y is the slant. A cylinder
// becomes a rectangle, and a cone becomes a sector of a ring.
struct RolloutSheet {
  DevelopedSurface surface;
  RolloutSide side = RolloutSide::outside;
  double from = 0, to = 0;  // radians, from < to ≤ from + 2π; the cut is at both
  double slant_from = 0, slant_to = 0;
  glm::dvec2 min{0}, max{0};  // the bounds of the unrolled part
  void find_bounds();         // sets `min` and `max` for the other members

  double middle() const { return (from + to) / 2; }
  // The sign of x where the angle is larger than the middle.
  double turn() const { return side == RolloutSide::outside ? 1 : -1; }
  struct SurfacePlace {
    double angle = 0, slant = 0;
  };
  glm::dvec2 on_sheet(const SurfacePlace& place) const;
  // The sheet of a wall that goes all around the axis continues past both ends of the cut, with the
  // surface at the other end. Returns by which angle: half a turn, or less if the sheet of a cone
  // would overlap itself. 0 for other walls.
  double beyond_cut() const;
  std::optional<SurfacePlace> on_surface(const glm::dvec2& sheet) const;  // nullopt: outside it
  SurfacePlace unbounded_place(const glm::dvec2& sheet) const;            // also outside it
  // Returns the direction of growing slants on the sheet. The lines of a cone fan out.
  glm::dvec2 up_at(double angle) const;
  // Returns a direction on the sheet as a direction in the world. `over` is the part of the
  // direction that points from the surface to the viewer.
  glm::dvec3 in_world(const SurfacePlace& place, const glm::dvec2& on_sheet, double over) const;
};

struct FittedSheet {
  DevelopedFit fit;
  RolloutSheet sheet;
};

// Finds the part of the surface that the walls of the model cover on this side. `cut` is an angle
// in radians. Without it, the cut is in the middle of the largest gap of the model, or, if there is
// no gap, opposite the angle 0. Checks the current question. Returns an `invalid` error if no
// triangle faces the side.
Result<RolloutSheet> plan_rollout(const Geometry& geometry, const DevelopedFit& fit,
                                  const std::optional<double>& cut);

// Returns the tree of a geometry. The tree of a large scan takes a while to build.
using TreeOf = std::function<std::shared_ptr<const SearchTree>()>;

// Fits a surface and plans its rollout. Calls `tree_of` only for a general cylinder. `up` is one of
// kUpDirections: a fitted axis points up, and the angle 0 is the front of the model. The request's
// own values for these two have no effect. Errors: those of fit_developed_surface, plan_rollout and
// fit_cross_section.
Result<FittedSheet> fit_sheet(const TreeOf& tree_of, const Geometry& geometry, FitRequest request,
                              const std::optional<double>& cut, std::string_view up);

}  // namespace strata::mesh
