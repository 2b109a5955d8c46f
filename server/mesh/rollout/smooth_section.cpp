#include "mesh/rollout/smooth_section.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <numbers>

namespace strata::mesh {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

constexpr std::size_t kMaxGap = 10;  // steps
constexpr double kCornerBend = 0.1;  // radians
constexpr int kCornerRounds = 6;     // of reweighting
constexpr int kBisections = 24;      // of the common logarithm of the weight
constexpr double kLow = -6, kHigh = 10;

// Fills unknown values linearly between the nearest known ones.
void fill_gaps(std::vector<double>& values, const std::vector<bool>& is_known) {
  const std::size_t count = values.size();
  const auto first = static_cast<std::size_t>(std::ranges::find(is_known, true) - is_known.begin());
  for (std::size_t from = first, step = 1; from < first + count; from += step) {
    step = 1;
    while (!is_known[(from + step) % count]) ++step;
    for (std::size_t i = 1; i < step; ++i)
      values[(from + i) % count] = std::lerp(values[from % count], values[(from + step) % count],
                                             static_cast<double>(i) / static_cast<double>(step));
  }
}

// Returns which values are in a gap that is too long for smoothing.
std::vector<bool> long_gaps(const std::vector<bool>& is_known) {
  const std::size_t count = is_known.size();
  std::vector<bool> is_open(count, false);
  std::size_t run = 0;
  for (std::size_t i = 0; i < 2 * count; ++i) {
    run = is_known[i % count] ? 0 : run + 1;
    if (run <= kMaxGap) continue;
    for (std::size_t k = 0; k < run; ++k) is_open[(i - k) % count] = true;
  }
  return is_open;
}

}  // namespace

std::vector<double> smooth_section(const std::vector<Estimate>& estimates) {
  const std::size_t count = estimates.size();
  const auto size = static_cast<Eigen::Index>(count);
  std::vector<double> values(count), errors;
  std::vector<bool> is_known(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = estimates[i].value;
    is_known[i] = estimates[i].is_known();
    if (is_known[i]) errors.push_back(estimates[i].error);
  }
  fill_gaps(values, is_known);
  const std::vector<bool> is_open = long_gaps(is_known);
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::ranges::nth_element(errors, middle);
  const double scale = *middle;
  Eigen::VectorXd weights(size);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = scale / estimates[i].error;
    // Without a penalty, the values of a long gap need any weight.
    weights[static_cast<Eigen::Index>(i)] = is_open[i] ? 1 : share * share;
  }
  // Without their mean, the values are small, which keeps the digits of the solution.
  const Eigen::Map<const Eigen::VectorXd> all(values.data(), size);
  const double mean = weights.dot(all) / weights.sum();
  const Eigen::VectorXd radii = (all.array() - mean).matrix();
  Matrix second(size, size);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = (i + count - 1) % count, after = (i + 1) % count;
    if (is_open[before] || is_open[i] || is_open[after]) continue;
    entries.emplace_back(i, before, 1);
    entries.emplace_back(i, i, -2);
    entries.emplace_back(i, after, 1);
  }
  second.setFromTriplets(entries.begin(), entries.end());
  const Matrix data(weights.asDiagonal());
  const Eigen::VectorXd target = weights.cwiseProduct(radii);
  const double corner = kCornerBend * 2 * std::numbers::pi / static_cast<double>(count);
  Eigen::VectorXd smoothed = radii, straight = Eigen::VectorXd::Ones(size);
  for (int round = 0; round < kCornerRounds; ++round) {
    const Matrix penalty = second.transpose() * straight.asDiagonal() * second;
    double low = kLow, high = kHigh;
    for (int i = 0; i < kBisections; ++i) {
      const double logarithm = (low + high) / 2;
      const Eigen::SimplicialLDLT<Matrix> solver(data + std::pow(10, logarithm) * penalty);
      const Eigen::VectorXd found = solver.solve(target);
      const double sum = (found - radii).cwiseAbs2().dot(weights) / (scale * scale);
      const bool is_near = sum <= static_cast<double>(errors.size());
      if (is_near) smoothed = found;
      (is_near ? low : high) = logarithm;
    }
    const Eigen::VectorXd bends = second * smoothed / corner;
    straight = (1 + bends.array().square()).inverse().matrix();
  }
  for (std::size_t i = 0; i < count; ++i) values[i] = mean + smoothed[static_cast<Eigen::Index>(i)];
  std::vector<bool> is_inside(count);
  for (std::size_t i = 0; i < count; ++i) is_inside[i] = !is_open[i];
  fill_gaps(values, is_inside);
  return values;
}

}  // namespace strata::mesh
