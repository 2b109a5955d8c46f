#include "mesh/analysis/model_change.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace strata::mesh {
namespace {

constexpr double kQuantile = 1.96;  // of the normal distribution: 95 % are within ± 1.96 σ
constexpr int kMinSamples = 4;
constexpr int kNormalPasses = 4;
constexpr float kSameCos = 0.94f;  // of 20°: the neighborhood is then nearly the same

// Returns t so that 95 % of Student's t distribution are within ± t. Few points underestimate their
// scatter more often than they overestimate it. Requires at least 1 degree of freedom, apart from
// rounding.
double student_quantile(double degrees_of_freedom) {
  // One quantile takes about 10 µs. The interpolation, over 1 / degrees, errs by less than 0.01.
  constexpr int kSteps = 64;
  static const auto quantiles = [] {
    std::array<double, kSteps + 1> at{kQuantile};
    for (int i = 1; i <= kSteps; ++i)
      at[i] = boost::math::quantile(
          boost::math::students_t_distribution(kSteps / static_cast<double>(i)), 0.975);
    return at;
  }();
  const double steps = kSteps / std::max(1.0, degrees_of_freedom);
  const int below = std::min(static_cast<int>(steps), kSteps - 1);
  return std::lerp(quantiles[below], quantiles[below + 1], steps - below);
}

// Sums of the samples in a cylinder.
struct Sums {
  double area = 0, first = 0, second = 0;  // Σ w, Σ w t, Σ w t²
  double area_squares = 0, vertices = 0;
  int samples = 0;

  void add(const SurfaceSamples::Sample& sample, double t) {
    const double w = sample.area;
    area += w;
    first += w * t;
    second += w * t * t;
    area_squares += w * w;
    vertices += std::min(1.0f, sample.vertices);
    ++samples;
  }
  double mean() const { return first / area; }
  // The number of independent points. It is the smaller of the number of vertices and Kish's
  // effective number of samples with unequal weights. The scatter of one point is unknown, so it is
  // at least 2.
  double count() const { return std::max(2.0, std::min(vertices, area * area / area_squares)); }
  double variance() const {
    const double biased = std::max(0.0, second / area - mean() * mean());
    return biased * count() / (count() - 1);
  }
};

// Returns the largest distance from a point to a box.
double farthest_distance(const glm::dvec3& point, const glm::dvec3& low, const glm::dvec3& high) {
  return glm::length(glm::max(glm::abs(point - low), glm::abs(point - high)));
}

double rounding_of(const Geometry& geometry) {
  const glm::vec3 size = glm::max(glm::abs(geometry.box_min), glm::abs(geometry.box_max));
  return double{std::numeric_limits<float>::epsilon()} * std::max({size.x, size.y, size.z});
}

}  // namespace

ModelChange::ModelChange(SurfaceSamples normals, Side here, Side there, const ChangeScales& scales)
    : normals_(std::move(normals)),
      here_(std::move(here)),
      there_(std::move(there)),
      scales_(scales),
      rounding_(0) {}

Result<ModelChange> ModelChange::make(const Geometry& here, double metres_here,
                                      const Geometry& there, double metres_there,
                                      const ChangeScales& scales, Progress& progress, double share,
                                      int threads) {
  const double there_per_here = metres_here / metres_there;
  const auto side = [&](const Geometry& geometry, double units_per_here) -> Result<Side> {
    auto samples = STRATA_TRY(
        SurfaceSamples::make(geometry, static_cast<float>(scales.projection / 2 * units_per_here),
                             progress, threads, SurfaceSamples::Pieces::vertices));
    return Side{std::move(samples), geometry.origin + glm::dvec3(geometry.box_min),
                geometry.origin + glm::dvec3(geometry.box_max), geometry.origin, units_per_here};
  };
  progress.begin_stage(0, share / 3);
  auto normals = STRATA_TRY(
      SurfaceSamples::make(here, static_cast<float>(scales.normal / 2), progress, threads));
  progress.begin_stage(share / 3, share * 2 / 3);
  auto own = STRATA_TRY(side(here, 1));
  progress.begin_stage(share * 2 / 3, share);
  auto other = STRATA_TRY(side(there, there_per_here));
  ModelChange change(std::move(normals), std::move(own), std::move(other), scales);
  change.rounding_ = rounding_of(here) + rounding_of(there) / there_per_here;
  return change;
}

// Extends the cylinder in steps until the surface nearest to the point ends, that is until a step
// adds no samples. So a second surface farther along the axis, such as another fold of a garment,
// does not disturb the mean. Skips steps far from any sample.
std::optional<ModelChange::Mean> ModelChange::mean_in_cylinder(const Side& side,
                                                               const glm::dvec3& world,
                                                               const glm::vec3& axis) const {
  const double scale = side.units_per_here;
  const glm::dvec3 place = world * scale;
  const double radius = scales_.projection / 2 * scale, step = radius;
  const double end = std::min(scales_.max_distance * scale,
                              farthest_distance(place, side.box_min, side.box_max) + step);
  const glm::vec3 point(place - side.origin);
  Sums sums;
  const auto add = [&](const SurfaceSamples::Sample& sample, float t) { sums.add(sample, t); };
  std::array<double, 2> empty{};  // the ends of the known empty parts, forward and backward
  for (double reach = 0; reach < end; reach += step) {
    const int before = sums.samples;
    const double next = std::min(reach + step, end);
    const auto from = static_cast<float>(reach), to = static_cast<float>(next);
    const auto can_have_samples = [&](int direction) {
      if (before > 0) return true;
      // A step has the length of a radius. One radius is the width of the cylinder, and another one
      // a margin for rounding.
      if (reach >= empty[direction] &&
          side.samples.is_clear_around(point + (direction == 0 ? from : -from) * axis))
        empty[direction] = reach + (SurfaceSamples::kClearRadii - 2) * radius;
      return empty[direction] < next;
    };
    if (can_have_samples(0)) side.samples.within_cylinder(point, axis, from, to, add);
    if (can_have_samples(1)) side.samples.within_cylinder(point, axis, -to, -from, add);
    if (before == 0 || sums.samples > before) continue;
    if (before >= kMinSamples) break;
    sums = {};  // the border of a surface that is mainly outside the cylinder
  }
  if (sums.samples < kMinSamples) return std::nullopt;
  return Mean{sums.mean() / scale, sums.variance() / sums.count() / (scale * scale), sums.count()};
}

// Noise can turn the surface at a single point by more than 80°, so that the first mean leaves out
// most of the neighborhood. The next mean is around the first.
glm::vec3 ModelChange::mean_normal(const glm::vec3& position, const glm::vec3& normal) const {
  glm::vec3 mean = normal;
  for (int pass = 0; pass < kNormalPasses; ++pass) {
    glm::dvec3 sum(0);
    normals_.near(position, mean, [&](const SurfaceSamples::Sample& sample, float) {
      sum += double{sample.area} * glm::dvec3(sample.normal);
    });
    const double length = glm::length(sum);
    if (!(length > 0)) break;
    const glm::vec3 next(sum / length);
    const bool is_same = glm::dot(next, mean) > kSameCos;
    mean = next;
    if (is_same) break;
  }
  return mean;
}

std::optional<ModelChange::Change> ModelChange::at(const glm::vec3& position,
                                                   const glm::vec3& normal) const {
  const glm::vec3 axis = mean_normal(position, normal);
  const glm::dvec3 world = here_.origin + glm::dvec3(position);
  const auto here = mean_in_cylinder(here_, world, axis);
  if (!here) return std::nullopt;
  const auto there = mean_in_cylinder(there_, world, axis);
  if (!there) return std::nullopt;
  // the degrees of freedom of Welch and Satterthwaite
  const double variance = here->variance + there->variance;
  const auto share = [](const Mean& mean) {
    return mean.variance * mean.variance / (mean.count - 1);
  };
  const double unshared = share(*here) + share(*there);
  const double quantile =
      unshared > 0 ? student_quantile(variance * variance / unshared) : kQuantile;
  return Change{
      here->position - there->position,
      std::max(quantile * std::sqrt(variance) + kQuantile * scales_.registration, rounding_)};
}

}  // namespace strata::mesh
