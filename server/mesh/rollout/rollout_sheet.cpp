#include "mesh/rollout/rollout_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "domain/scene/up.h"
#include "mesh/rollout/face_samples.h"
#include "mesh/rollout/fit_cross_section.h"

namespace strata::mesh {
namespace {

constexpr int kSectors = 720;
constexpr int kMinGap = 3;  // in sectors; smaller gaps come from rounding

// Returns the equal angle from 0 to 2π.
double wrapped(double angle) {
  const double rest = std::fmod(angle, kTurn);
  return rest < 0 ? rest + kTurn : rest;
}

// Calls `see` with the places of the corners of each triangle of the walls on this side. The angles
// of a triangle differ by less than π.
template <class See>
void for_each_wall(const Geometry& geometry, const DevelopedFit& fit, See see) {
  const DevelopedSurface& surface = fit.surface;
  const double facing = fit.side == RolloutSide::outside ? 1 : -1;
  for (std::size_t t = 0; t < geometry.triangle_count(); ++t) {
    if (t % kTrianglesAtOnce == 0) check_question();
    std::array<glm::dvec3, 3> corners;
    std::array<DevelopedSurface::Place, 3> places;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vertex& vertex = geometry.vertices[geometry.indices[3 * t + k]];
      corners[k] = geometry.positions[vertex.position_index];
      places[k] = surface.place_of(corners[k]);
      if (k > 0)
        places[k].angle =
            places[0].angle + std::remainder(places[k].angle - places[0].angle, kTurn);
    }
    const glm::dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (std::abs(glm::dot(cross, surface.axis)) > kFloorCosine * glm::length(cross)) continue;
    const double angle = (places[0].angle + places[1].angle + places[2].angle) / 3;
    if (facing * glm::dot(cross, surface.ray(angle)) > 0) see(places);
  }
}

// Returns the middle of the largest gap between the covered sectors, or nullopt without a gap.
std::optional<double> widest_gap(const std::array<bool, kSectors>& is_covered) {
  int best = 0, best_end = 0, run = 0;
  for (int i = 0; i < 2 * kSectors; ++i) {
    run = is_covered[static_cast<std::size_t>(i % kSectors)] ? 0 : run + 1;
    if (run > best) best = run, best_end = i + 1;
  }
  if (best < kMinGap) return std::nullopt;
  return (best_end - best / 2.0) * kTurn / kSectors;
}

}  // namespace

void RolloutSheet::find_bounds() {
  min = glm::dvec2(std::numeric_limits<double>::infinity());
  max = -min;
  const auto add = [&](double angle) {
    for (const double slant : {slant_from, slant_to}) {
      const glm::dvec2 corner = on_sheet({angle, slant});
      min = glm::min(min, corner);
      max = glm::max(max, corner);
    }
  };
  add(from);
  add(middle());
  add(to);
  if (!surface.is_cone()) return;
  // A ring has its extremes where the angle on the sheet is a multiple of 90°.
  const double quarter = kTurn / 4 / std::abs(std::sin(surface.half_angle));
  for (const double angle : {middle() - quarter, middle() + quarter})
    if (angle > from && angle < to) add(angle);
}

glm::dvec2 RolloutSheet::on_sheet(const SurfacePlace& place) const {
  if (!surface.is_cone())
    return {turn() * (surface.arc(place.angle) - surface.arc(middle())), place.slant};
  const double sine = std::sin(surface.half_angle), apex = surface.apex();
  const double angle = turn() * (place.angle - middle()) * std::abs(sine),
               from_apex = place.slant - apex;
  return {std::abs(from_apex) * std::sin(angle), apex + from_apex * std::cos(angle)};
}

double RolloutSheet::beyond_cut() const {
  if (to - from < kTurn - kAngleRounding) return 0;
  // The sector of a cone leaves a gap on the plane. Both ends continue to the middle of the gap.
  const double fan = kTurn * std::abs(std::sin(surface.half_angle));
  return surface.is_cone() ? std::min(kTurn / 2, (kTurn - fan) / 2 / fan * kTurn) : kTurn / 2;
}

RolloutSheet::SurfacePlace RolloutSheet::unbounded_place(const glm::dvec2& sheet) const {
  if (surface.section)
    return {surface.section->angle_at(surface.arc(middle()) + turn() * sheet.x), sheet.y};
  if (!surface.is_cone()) return {middle() + turn() * sheet.x / surface.radius, sheet.y};
  const double sine = std::sin(surface.half_angle), apex = surface.apex();
  const double sign = sine < 0 ? -1 : 1;
  const double around = std::atan2(sheet.x, sign * (sheet.y - apex)) / std::abs(sine);
  return {middle() + turn() * around, apex + sign * std::hypot(sheet.x, sheet.y - apex)};
}

std::optional<RolloutSheet::SurfacePlace> RolloutSheet::on_surface(const glm::dvec2& sheet) const {
  const SurfacePlace place = unbounded_place(sheet);
  const bool is_inside = std::abs(place.angle - middle()) <= (to - from) / 2 &&
                         place.slant >= slant_from && place.slant <= slant_to;
  return is_inside ? std::optional(place) : std::nullopt;
}

glm::dvec2 RolloutSheet::up_at(double angle) const {
  const double fan = turn() * (angle - middle()) * std::sin(surface.half_angle);
  return {std::sin(fan), std::cos(fan)};
}

glm::dvec3 RolloutSheet::in_world(const SurfacePlace& place, const glm::dvec2& on_sheet,
                                  double over) const {
  const glm::dvec2 up = up_at(place.angle), right(up.y, -up.x);
  return glm::dot(on_sheet, right) * turn() * surface.tangent(place.angle) +
         glm::dot(on_sheet, up) * surface.generator(place.angle) +
         over * turn() * surface.normal(place.angle);
}

Result<RolloutSheet> plan_rollout(const Geometry& geometry, const DevelopedFit& fit,
                                  const std::optional<double>& cut) {
  RolloutSheet sheet;
  sheet.surface = fit.surface;
  sheet.side = fit.side;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  sheet.slant_from = kInfinity;
  sheet.slant_to = -kInfinity;
  std::array<bool, kSectors> is_covered{};
  for_each_wall(geometry, fit, [&](const std::array<DevelopedSurface::Place, 3>& corners) {
    const auto [low, high] = std::minmax({corners[0].angle, corners[1].angle, corners[2].angle});
    const auto first = static_cast<long>(std::floor(low / kTurn * kSectors));
    const auto last = static_cast<long>(std::floor(high / kTurn * kSectors));
    for (long i = first; i <= last; ++i)
      is_covered[static_cast<std::size_t>((i % kSectors + kSectors) % kSectors)] = true;
    for (const auto& corner : corners) {
      sheet.slant_from = std::min(sheet.slant_from, corner.slant);
      sheet.slant_to = std::max(sheet.slant_to, corner.slant);
    }
  });
  if (sheet.surface.is_cone()) {
    double& tip = sheet.surface.half_angle > 0 ? sheet.slant_from : sheet.slant_to;
    tip = sheet.surface.half_angle > 0 ? std::max(tip, sheet.surface.apex())
                                       : std::min(tip, sheet.surface.apex());
  }
  if (!(sheet.slant_from < sheet.slant_to))
    return fail(ErrorCode::invalid, "No surface on this side",
                "No wall around the axis faces this side. Choose the other side, or change the "
                "axis.",
                "side");
  const auto gap = widest_gap(is_covered);
  const double start = cut.value_or(gap.value_or(std::numbers::pi));
  double low = 0, high = kTurn;
  if (gap) {
    low = kTurn;
    high = 0;
    for_each_wall(geometry, fit, [&](const std::array<DevelopedSurface::Place, 3>& corners) {
      const auto [first, last] =
          std::minmax({corners[0].angle, corners[1].angle, corners[2].angle});
      double from = wrapped(first - start);
      // Because of rounding, a wall that begins or ends at the cut can cross it.
      if (from > kTurn - kAngleRounding) from -= kTurn;
      const double to = from + (last - first);
      low = std::min(low, to > kTurn + kAngleRounding ? 0 : from);
      high = std::max(high, std::min(to, kTurn));
    });
  }
  // The middle is an angle from −π to π.
  const double middle = std::remainder(start + (low + high) / 2, kTurn);
  sheet.from = middle - (high - low) / 2;
  sheet.to = middle + (high - low) / 2;
  sheet.find_bounds();
  return sheet;
}

Result<FittedSheet> fit_sheet(const TreeOf& tree_of, const Geometry& geometry, FitRequest request,
                              const std::optional<double>& cut, std::string_view up) {
  const UpFrame frame = up_frame(up);
  request.up = frame.up;
  request.zero = -frame.into;  // the front of the model
  FittedSheet fitted;
  fitted.fit = STRATA_TRY(fit_developed_surface(geometry, request));
  fitted.sheet = STRATA_TRY(plan_rollout(geometry, fitted.fit, cut));
  if (request.shape == DevelopedShape::general_cylinder)
    STRATA_TRY(fit_cross_section(*tree_of(), geometry, request, fitted));
  return fitted;
}

}  // namespace strata::mesh
