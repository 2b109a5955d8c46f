#include "mesh/rollout/fit_cross_section.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mesh/parallel.h"
#include "mesh/rollout/robust_section.h"
#include "mesh/rollout/rollout_rays.h"

namespace strata::mesh {
namespace {

constexpr int kCorners = 720;
constexpr int kRays = 128;  // along the axis
// A corner is at least this share of the mean radius away from the axis.
constexpr double kMinRadius = 1e-3;
// The largest spread of a shape with one cross section. Scanned vessels have less than 2 %, and
// statues more than 15 %.
constexpr double kMaxSpread = 0.1;

tl::unexpected<Error> no_section(const std::string& why) {
  return fail(ErrorCode::invalid, "No cross section found",
              why +
                  " Choose the shape `cylinder` or `cone`, for example for a vessel, or set the "
                  "axis to unroll the model anyway.",
              "axis");
}

}  // namespace

Result<void> fit_cross_section(const SearchTree& tree, const Geometry& geometry,
                               const FitRequest& request, FittedSheet& fitted) {
  RolloutSheet& sheet = fitted.sheet;
  const DevelopedSurface& circle = sheet.surface;
  const RolloutRays rays(tree, geometry, sheet);
  std::vector<Direction> directions(kCorners);
  parallel_for(background_threads(), kCorners, [&](int corner) {
    // The angle as it is on the sheet.
    const double angle =
        sheet.middle() + std::remainder(kTurn * corner / kCorners - sheet.middle(), kTurn);
    for (int i = 0; i < kRays; ++i) {
      const double share = (i + 0.5) / kRays;
      const auto hit =
          rays.cast(sheet.on_sheet({angle, std::lerp(sheet.slant_from, sheet.slant_to, share)}));
      if (!hit) continue;
      const glm::dvec3 place = geometry.origin + glm::dvec3(hit->hit.position);
      const double distance =
          std::max(circle.place_of(place).height + circle.radius, kMinRadius * circle.radius);
      directions[static_cast<std::size_t>(corner)].push_back(
          {static_cast<std::size_t>(i), std::log(distance)});
    }
  });
  if (std::ranges::all_of(directions, &Direction::empty))
    return fail(ErrorCode::invalid, "No surface around the axis",
                "No ray between the axis and the outside meets a wall that faces this side. Choose "
                "the other side, or move the axis.",
                "axis");
  RobustSection found = fit_robust_section(directions, kRays);
  double squares = 0, count = 0, sum = 0;
  for (std::size_t i = 0; i < kCorners; ++i)
    for (const DistanceSample& sample : directions[i]) {
      const double distance = std::exp(sample.log);
      squares += (distance - found.radii[i]) * (distance - found.radii[i]);
      sum += distance;
      ++count;
    }
  const double deviation = std::sqrt(squares / count);
  if (!request.axis && !(found.spread <= kMaxSpread))
    return no_section("The shape of the cross section changes along the axis.");
  if (!request.axis && !(deviation <= kMaxDeviation * sum / count))
    return no_section("The radius changes too much along the axis.");
  auto section = std::make_shared<const CrossSection>(std::move(found.radii));
  for (DevelopedSurface* surface : {&fitted.fit.surface, &sheet.surface}) {
    surface->radius = section->length() / kTurn;
    surface->section = section;
  }
  fitted.fit.deviation = deviation;
  sheet.find_bounds();
  return {};
}

}  // namespace strata::mesh
