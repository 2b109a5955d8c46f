#include "mesh/rollout/fit_cross_section.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/parallel.h"
#include "mesh/rollout/rollout_rays.h"

namespace strata::mesh {
namespace {

constexpr int kCorners = 720;
constexpr int kRays = 128;  // along the axis
// A corner is at least this share of the mean radius away from the axis.
constexpr double kMinRadius = 1e-3;

// Fills the corners without a radius (0) linearly between the nearest ones with a radius.
void fill_gaps(std::vector<double>& radii) {
  const std::size_t count = radii.size();
  const auto first = static_cast<std::size_t>(
      std::ranges::find_if(radii, [](double radius) { return radius > 0; }) - radii.begin());
  for (std::size_t from = first, step = 1; from < first + count; from += step) {
    step = 1;
    while (radii[(from + step) % count] == 0) ++step;
    for (std::size_t i = 1; i < step; ++i)
      radii[(from + i) % count] = std::lerp(radii[from % count], radii[(from + step) % count],
                                            static_cast<double>(i) / static_cast<double>(step));
  }
}

// Returns the standard deviation of the noise, from the second differences. Edges of a pillar have
// no effect, because it is a median.
double noise_of(const Eigen::VectorXd& radii) {
  const Eigen::Index count = radii.size();
  std::vector<double> differences;
  for (Eigen::Index i = 0; i < count; ++i)
    differences.push_back(
        std::abs(radii[(i + 1) % count] - 2 * radii[i] + radii[(i + count - 1) % count]));
  const auto middle = differences.begin() + count / 2;
  std::ranges::nth_element(differences, middle);
  return 1.4826 * *middle / std::sqrt(6.0);
}

// Reduces noise, which would make the section longer. The smoothed section has the least sum of
// squared second differences of all that deviate from the radii by their noise (Whittaker 1923 with
// the discrepancy principle of Morozov). So a section without noise keeps its edges.
void smooth(std::vector<double>& section) {
  const auto count = static_cast<Eigen::Index>(section.size());
  const Eigen::Map<Eigen::VectorXd> radii(section.data(), count);
  Eigen::SparseMatrix<double> identity(count, count), second(count, count);
  identity.setIdentity();
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < count; ++i) {
    entries.emplace_back(i, (i + count - 1) % count, 1);
    entries.emplace_back(i, i, -2);
    entries.emplace_back(i, (i + 1) % count, 1);
  }
  second.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseMatrix<double> squares = second.transpose() * second;
  const double noise = noise_of(radii);
  Eigen::VectorXd smoothed = radii;
  double low = -6, high = 8;  // of the common logarithm of the weight
  for (int round = 0; round < 20; ++round) {
    const double middle = (low + high) / 2;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(identity +
                                                                    std::pow(10, middle) * squares);
    const Eigen::VectorXd found = solver.solve(radii);
    const bool is_near = (found - radii).norm() <= noise * std::sqrt(static_cast<double>(count));
    if (is_near) smoothed = found;
    (is_near ? low : high) = middle;
  }
  for (Eigen::Index i = 0; i < count; ++i)
    section[static_cast<std::size_t>(i)] =
        std::max(smoothed[i], section[static_cast<std::size_t>(i)] / 2);
}

}  // namespace

Result<void> fit_cross_section(const SearchTree& tree, const Geometry& geometry,
                               const FitRequest& request, FittedSheet& fitted) {
  RolloutSheet& sheet = fitted.sheet;
  const DevelopedSurface& circle = sheet.surface;
  const RolloutRays rays(tree, geometry, sheet);
  std::vector<std::vector<double>> distances(kCorners);  // from the axis
  parallel_for(background_threads(), kCorners, [&](int corner) {
    // The angle as it is on the sheet.
    const double angle =
        sheet.middle() + std::remainder(kTurn * corner / kCorners - sheet.middle(), kTurn);
    auto& found = distances[static_cast<std::size_t>(corner)];
    for (int i = 0; i < kRays; ++i) {
      const double slant = std::lerp(sheet.slant_from, sheet.slant_to, (i + 0.5) / kRays);
      const auto hit = rays.cast(sheet.on_sheet({angle, slant}));
      if (!hit) continue;
      const glm::dvec3 place = geometry.origin + glm::dvec3(hit->hit.position);
      found.push_back(
          std::max(circle.place_of(place).height + circle.radius, kMinRadius * circle.radius));
    }
    std::ranges::sort(found);
  });
  std::vector<double> radii(kCorners, 0);
  double squares = 0, count = 0, sum = 0;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const auto& found = distances[i];
    if (found.empty()) continue;
    radii[i] = found[found.size() / 2];
    for (const double distance : found) {
      squares += (distance - radii[i]) * (distance - radii[i]);
      sum += distance;
      ++count;
    }
  }
  const double deviation = std::sqrt(squares / count);
  if (count == 0)
    return fail(ErrorCode::invalid, "No surface around the axis",
                "No ray between the axis and the outside meets a wall that faces this side. Choose "
                "the other side, or move the axis.",
                "axis");
  if (!request.axis && !(deviation <= kMaxDeviation * sum / count))
    return fail(ErrorCode::invalid, "No cross section found",
                "The cross section of the model changes too much along its axis. Set the axis, or "
                "create a figure without a rollout.",
                "axis");
  fill_gaps(radii);
  smooth(radii);
  auto section = std::make_shared<const CrossSection>(std::move(radii));
  for (DevelopedSurface* surface : {&fitted.fit.surface, &sheet.surface}) {
    surface->radius = section->length() / kTurn;
    surface->section = section;
  }
  fitted.fit.deviation = deviation;
  sheet.find_bounds();
  return {};
}

}  // namespace strata::mesh
