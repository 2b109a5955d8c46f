#pragma once

#include <optional>

#include "core/error.h"
#include "mesh/rollout/developed_surface.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The side of a wall that a rollout shows: outside as seen from around the model, inside as seen
// from the axis.
enum class RolloutSide { outside, inside };

// What the caller knows about the surface. All other values are fitted.
struct FitRequest {
  struct Axis {
    glm::dvec3 point{0};      // in world coordinates
    glm::dvec3 direction{0};  // of any length except 0
    bool operator==(const Axis&) const = default;
  };
  std::optional<Axis> axis{};
  std::optional<double> radius{};      // at `axis->point`; without half_angle: of a cylinder
  std::optional<double> half_angle{};  // in radians; only with a radius
  // Only without a radius. nullopt: a cylinder, or a cone if it fits clearly better.
  std::optional<DevelopedShape> shape{};
  std::optional<RolloutSide> side{};  // nullopt: the side with the larger area
  glm::dvec3 up{0, 0, 1};             // a fitted axis points up
  // The direction of the angle 0, projected perpendicularly to the axis. A direction parallel to
  // the axis is replaced.
  glm::dvec3 zero{1, 0, 0};
  bool operator==(const FitRequest&) const = default;
};

// A fitted surface that deviates more, as a share of its radius, is refused.
inline constexpr double kMaxDeviation = 1.0 / 3;

struct DevelopedFit {
  DevelopedSurface surface;
  RolloutSide side = RolloutSide::outside;
  double deviation = 0;  // RMS distance of the model's surface on this side, in units
};

// Fits a cylinder or cone to a model: first its axis (fit_axis.h), and then the radius as a linear
// function of the height. Both steps reduce the weight of triangles that fit badly, such as
// handles. Of a general cylinder, fits only the axis and the mean radius, for fit_cross_section.
// Returns an `invalid` error on the field `axis`, with what to do, if the model has no unique axis,
// is flat, or deviates from the surface by more than a third of the radius. With an axis of the
// caller, only a side without any surface is an error. Checks the current question. Takes about
// half a second per million triangles.
Result<DevelopedFit> fit_developed_surface(const Geometry& geometry, const FitRequest& request);

}  // namespace strata::mesh
