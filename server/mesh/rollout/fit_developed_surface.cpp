#include "mesh/rollout/fit_developed_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "mesh/rollout/face_samples.h"
#include "mesh/rollout/fit_axis.h"

namespace strata::mesh {
namespace {

constexpr int kRounds = 6;             // of reweighted least squares
constexpr double kMinWallShare = 0.1;  // of the area; below, the model is a flat sheet
constexpr double kMinAngle = std::numbers::pi / 6;
constexpr double kMaxSlope = 3.7;  // tan 75°: steeper cones are almost flat
// A cone is chosen if it reduces the deviation by this factor and is not almost a cylinder.
constexpr double kConeGain = 0.7, kMinConeSlope = 0.0175;  // tan 1°

// A meridian of the surface: radius = at_zero + slope · height.
struct Meridian {
  double at_zero = 0, slope = 0;
  double deviation = std::numeric_limits<double>::infinity();  // RMS distance
};

// A part of a wall in the coordinates of an axis.
struct WallSample {
  double radius, height, area;
};

double deviation_of(const std::vector<WallSample>& wall, const Meridian& line) {
  double squares = 0, area = 0;
  for (const WallSample& sample : wall) {
    const double e = sample.radius - line.at_zero - line.slope * sample.height;
    squares += sample.area * e * e;
    area += sample.area;
  }
  return std::sqrt(squares / area) / std::hypot(1.0, line.slope);
}

Meridian fit_meridian(const std::vector<WallSample>& wall, bool is_cone) {
  Meridian line;
  for (int round = 0; round < kRounds; ++round) {
    double w = 0, wh = 0, wr = 0, whh = 0, whr = 0;
    for (const WallSample& sample : wall) {
      double weight = sample.area;
      if (round > 0) {
        const double e = (sample.radius - line.at_zero - line.slope * sample.height) /
                         std::max(2 * line.deviation, 1e-9 * line.at_zero);
        weight /= 1 + e * e;
      }
      w += weight;
      wh += weight * sample.height;
      wr += weight * sample.radius;
      whh += weight * sample.height * sample.height;
      whr += weight * sample.height * sample.radius;
    }
    const double spread = whh - wh * wh / w;
    line.slope = is_cone && spread > 1e-12 * whh
                     ? std::clamp((whr - wh * wr / w) / spread, -kMaxSlope, kMaxSlope)
                     : 0;
    line.at_zero = (wr - line.slope * wh) / w;
    line.deviation = deviation_of(wall, line);
  }
  return line;
}

// The walls of a model around an axis.
struct Walls {
  std::vector<WallSample> outside, inside;
  double outside_area = 0, inside_area = 0, all_area = 0;
  double angle = 0;  // that the walls cover around the axis, in radians
};

// `axis` is a cylinder with the radius 0, whose heights are distances from the axis.
Walls walls_around(const Geometry& geometry, const DevelopedSurface& axis) {
  constexpr int kSectors = 72;
  std::array<bool, kSectors> is_covered{};
  Walls walls;
  for_each_face(geometry, axis.point, [&](const FaceSample& sample) {
    walls.all_area += sample.area;
    if (std::abs(glm::dot(sample.normal, axis.axis)) > kFloorCosine) return;
    const auto place = axis.place_of(axis.point + sample.place);
    const double facing = glm::dot(sample.normal, axis.radial(place.angle));
    const WallSample wall{place.height, place.slant, sample.area};
    if (facing > 0) {
      walls.outside.push_back(wall);
      walls.outside_area += sample.area;
    } else if (facing < 0) {
      walls.inside.push_back(wall);
      walls.inside_area += sample.area;
    }
    const double sector = (place.angle / kTurn + 0.5) * kSectors;
    is_covered[static_cast<std::size_t>(std::clamp(sector, 0.0, kSectors - 1.0))] = true;
  });
  walls.angle = static_cast<double>(std::ranges::count(is_covered, true)) * kTurn / kSectors;
  return walls;
}

tl::unexpected<Error> no_rollout(const std::string& why) {
  return fail(ErrorCode::invalid, "No cylinder or cone found",
              why + " Set the axis, or create a figure without a rollout.", "axis");
}

// An axis that lies flat, as of a barrel vault, points along its largest coordinate.
glm::dvec3 pointing_up(const glm::dvec3& axis, const glm::dvec3& up) {
  double along = glm::dot(axis, up);
  if (std::abs(along) < 0.1) {
    const glm::dvec3 size_of = glm::abs(axis);
    along = axis[size_of.x >= size_of.y && size_of.x >= size_of.z ? 0
                 : size_of.y >= size_of.z                         ? 1
                                                                  : 2];
  }
  return along < 0 ? -axis : axis;
}

glm::dvec3 perpendicular(const glm::dvec3& axis, const glm::dvec3& wanted) {
  for (const glm::dvec3& each :
       {wanted, glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) {
    const glm::dvec3 flat = each - glm::dot(each, axis) * axis;
    if (glm::length(flat) > 0.1 * glm::length(each)) return glm::normalize(flat);
  }
  return {1, 0, 0};  // not reached: one of three axes is perpendicular enough
}

}  // namespace

Result<DevelopedFit> fit_developed_surface(const Geometry& geometry, const FitRequest& request) {
  DevelopedFit fit;
  DevelopedSurface& surface = fit.surface;
  surface.radius = 0;
  const bool is_general = request.shape == DevelopedShape::general_cylinder;
  if (request.axis) {
    surface.point = request.axis->point;
    surface.axis = glm::normalize(request.axis->direction);
  } else {
    auto axis = is_general ? fit_cylinder_axis(geometry) : std::nullopt;
    // The walls of a bellied vessel are not parallel to its axis.
    if (!axis) axis = fit_revolution_axis(geometry);
    if (!axis)
      return no_rollout(
          "The model has no unique axis. It is similar to a sphere or cube, or it is flat.");
    surface.point = axis->point;
    surface.axis = pointing_up(axis->direction, request.up);
  }
  surface.zero = perpendicular(surface.axis, request.zero);
  const Walls walls = walls_around(geometry, surface);
  if (!request.axis && (walls.outside_area + walls.inside_area < kMinWallShare * walls.all_area ||
                        walls.angle < kMinAngle))
    return no_rollout("The model is flat.");
  fit.side = request.side.value_or(walls.outside_area >= walls.inside_area ? RolloutSide::outside
                                                                           : RolloutSide::inside);
  const bool is_outside = fit.side == RolloutSide::outside;
  const auto& wall = is_outside ? walls.outside : walls.inside;
  if (wall.empty())
    return fail(ErrorCode::invalid, "No surface on this side",
                std::string("No wall around the axis faces ") +
                    (is_outside ? "outward. Choose the inside" : "the axis. Choose the outside") +
                    ", or change the axis.",
                "side");
  Meridian line;
  if (!request.radius) line = fit_meridian(wall, request.shape == DevelopedShape::cone);
  if (!request.shape && !request.radius) {
    const Meridian cone = fit_meridian(wall, true);
    if (cone.deviation < kConeGain * line.deviation && std::abs(cone.slope) > kMinConeSlope)
      line = cone;
  }
  if (request.radius) {
    line.at_zero = *request.radius;
    line.slope = std::tan(request.half_angle.value_or(0));
    line.deviation = deviation_of(wall, line);
  } else if (!request.axis) {
    // The plane through `point` is in the middle of the walls, so the radius is not negative there.
    const auto [low, high] = std::ranges::minmax_element(wall, {}, &WallSample::height);
    const double middle = (low->height + high->height) / 2;
    surface.point += middle * surface.axis;
    line.at_zero += line.slope * middle;
  }
  if (!(line.at_zero > 0))
    return fail(ErrorCode::invalid, "No radius at the point of the axis",
                "The fitted cone has its tip beyond the point of the axis. Move the point of the "
                "axis to the middle of the wall.",
                "axis.point");
  if (!request.axis && !is_general && !(line.deviation <= kMaxDeviation * line.at_zero))
    return no_rollout("The walls of the model differ too much from a cylinder or cone.");
  surface.radius = line.at_zero;
  surface.half_angle = std::abs(line.slope) < 1e-9 ? 0 : std::atan(line.slope);
  fit.deviation = line.deviation;
  return fit;
}

}  // namespace strata::mesh
