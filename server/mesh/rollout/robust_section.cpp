#include "mesh/rollout/robust_section.h"

#include <algorithm>
#include <cmath>

#include "mesh/rollout/smooth_section.h"

namespace strata::mesh {
namespace {

constexpr int kPolishRounds = 8;
constexpr int kMeanRounds = 12;
// Samples at this many standard deviations or more have no weight.
constexpr double kTukey = 4.685;
// The smallest standard deviation of a logarithm: rays store distances as floats.
constexpr double kRounding = 3e-6;
// Of a normal distribution: the standard deviation as a multiple of the median error, and the half
// width of the middle third as a share of the standard deviation.
constexpr double kNormalOfMedian = 1.4826, kThirdOfNormal = 0.4307;
constexpr double kPriorSamples = 4;
// A direction is clear if at least this share of its samples is around one value. In others, a
// handle can hide the wall. Their values have a large error, until a value near the section of the
// clear directions is found around which there is at least the smaller share.
constexpr double kClearShare = 0.65, kMinShare = 0.2, kUnclearError = 1;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

std::vector<double> logs_of(const Direction& direction) {
  std::vector<double> logs;
  for (const DistanceSample& sample : direction) logs.push_back(sample.log);
  return logs;
}

// Divides the distances by the scales of their heights, whose median is 1.
void remove_scales(std::vector<Direction>& directions, std::size_t row_count) {
  std::vector<double> radii(directions.size(), 0), scales(row_count, 0);  // logarithms
  for (int round = 0; round < kPolishRounds; ++round) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      std::vector<double> logs;
      for (const DistanceSample& sample : directions[i])
        logs.push_back(sample.log - scales[sample.row]);
      if (!logs.empty()) radii[i] = median_of(std::move(logs));
    }
    std::vector<std::vector<double>> rows(row_count);
    for (std::size_t i = 0; i < directions.size(); ++i)
      for (const DistanceSample& sample : directions[i])
        rows[sample.row].push_back(sample.log - radii[i]);
    std::vector<double> all;  // of the samples
    for (std::size_t k = 0; k < row_count; ++k) {
      if (rows[k].empty()) continue;
      const std::size_t count = rows[k].size();
      scales[k] = median_of(std::move(rows[k]));
      all.insert(all.end(), count, scales[k]);
    }
    const double middle = median_of(std::move(all));
    for (double& scale : scales) scale -= middle;
  }
  for (Direction& direction : directions)
    for (DistanceSample& sample : direction) sample.log -= scales[sample.row];
}

// Samples around a value.
struct Cluster {
  double value = 0;
  double deviation = 0;  // the standard deviation that sets the weights
  double weight = 0;     // of the samples
};

// Returns the shortest interval that contains a third of the samples. It is usually on the wall,
// also where a handle hides a part of the wall.
Cluster densest(const Direction& direction) {
  std::vector<double> logs = logs_of(direction);
  std::ranges::sort(logs);
  const std::size_t third = (logs.size() - 1) / 3;
  std::size_t best = 0;
  for (std::size_t i = 0; i + third < logs.size(); ++i)
    if (logs[i + third] - logs[i] < logs[best + third] - logs[best]) best = i;
  return {(logs[best] + logs[best + third]) / 2,
          (logs[best + third] - logs[best]) / 2 / kThirdOfNormal, 0};
}

double biweight(double error, double deviation) {
  const double e = error / (kTukey * deviation), rest = 1 - e * e;
  return rest > 0 ? rest * rest : 0;
}

// Moves a cluster to the robust mean of the samples around it.
Cluster moved_to_mean(const Direction& direction, Cluster cluster) {
  for (int round = 0; round < kMeanRounds; ++round) {
    double weights = 0, sum = 0;
    for (const DistanceSample& sample : direction) {
      const double error = sample.log - cluster.value, weight = biweight(error, cluster.deviation);
      weights += weight;
      sum += weight * error;
    }
    if (!(weights > 0)) return {cluster.value, cluster.deviation, 0};
    cluster.value += sum / weights;
    cluster.weight = weights;
  }
  return cluster;
}

double deviation_of(std::vector<double> errors) {
  for (double& each : errors) each = std::abs(each);
  return std::max(kNormalOfMedian * median_of(std::move(errors)), kRounding);
}

// Returns the standard deviation of the samples in a usual direction.
double usual_deviation(const std::vector<Direction>& directions) {
  std::vector<double> deviations;
  for (const Direction& direction : directions) {
    if (direction.empty()) continue;
    std::vector<double> errors = logs_of(direction);
    const double middle = median_of(errors);
    for (double& each : errors) each -= middle;
    deviations.push_back(deviation_of(std::move(errors)));
  }
  return median_of(std::move(deviations));
}

// The errors of the samples of a cluster, for each row, each times the root of its weight.
struct Errors {
  std::vector<double> rows;
  double variance = 0;
};

// Returns the errors from the line along the axis that fits best. Where the wall leans, the errors
// from the mean are larger, but the mean is as precise.
Errors errors_of(const Direction& direction, const Cluster& cluster, std::size_t row_count) {
  double weights = 0, wr = 0, we = 0, wrr = 0, wre = 0;
  for (const DistanceSample& sample : direction) {
    const double error = sample.log - cluster.value, weight = biweight(error, cluster.deviation);
    const auto row = static_cast<double>(sample.row);
    weights += weight;
    wr += weight * row;
    we += weight * error;
    wrr += weight * row * row;
    wre += weight * row * error;
  }
  Errors errors{std::vector<double>(row_count, 0), kRounding * kRounding};
  if (!(weights > 0)) return errors;
  const double middle = wr / weights, mean = we / weights, extent = wrr - wr * middle;
  const double slope = extent > 0.5 ? (wre - wr * mean) / extent : 0;
  for (const DistanceSample& sample : direction) {
    const double error = sample.log - cluster.value;
    const double rest = error - mean - slope * (static_cast<double>(sample.row) - middle);
    errors.rows[sample.row] = rest * std::sqrt(biweight(error, cluster.deviation));
    errors.variance += errors.rows[sample.row] * errors.rows[sample.row] / weights;
  }
  return errors;
}

// Returns how many neighboring samples count as one, because bumps are larger than the distance
// between two rows: the sum of the correlations of the errors up to the first negative one.
double dependent_samples(const std::vector<Errors>& directions, std::size_t row_count) {
  std::vector<double> products(row_count, 0);  // by the distance of two rows
  for (const auto& [rows, variance] : directions)
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (std::size_t j = k; j < rows.size(); ++j) products[k] += rows[j] * rows[j - k];
  double count = 1;
  for (std::size_t k = 1; k < row_count && products[k] > 0; ++k)
    count += 2 * products[k] / products[0];
  return count;
}

// Returns the logarithms of the radii.
std::vector<double> fit_radii(const std::vector<Direction>& directions, std::size_t row_count) {
  const double deviation = usual_deviation(directions);
  std::vector<Cluster> clusters(directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (directions[i].empty()) continue;
    Cluster start = densest(directions[i]);
    start.deviation = std::max(start.deviation, deviation);
    clusters[i] = moved_to_mean(directions[i], start);
  }
  std::vector<Errors> errors(directions.size());
  std::vector<double> variances;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (directions[i].empty()) continue;
    errors[i] = errors_of(directions[i], clusters[i], row_count);
    variances.push_back(errors[i].variance);
  }
  const double dependent = dependent_samples(errors, row_count),
               usual = median_of(std::move(variances));
  const auto estimate_of = [&](const Cluster& cluster, double variance) {
    // The usual variance counts as much as a few samples, because that of few samples is uncertain.
    const double prior = kPriorSamples * dependent;
    const double mixed = std::lerp(variance, usual, prior / (cluster.weight + prior));
    return Estimate{cluster.value, std::sqrt(mixed * dependent / cluster.weight)};
  };
  std::vector<Estimate> estimates(directions.size());
  std::vector<std::size_t> unclear;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (directions[i].empty()) continue;
    estimates[i] = estimate_of(clusters[i], errors[i].variance);
    if (clusters[i].weight >= kClearShare * static_cast<double>(directions[i].size())) continue;
    estimates[i].error = std::max(estimates[i].error, kUnclearError);
    unclear.push_back(i);
  }
  std::vector<double> logs = smooth_section(estimates);
  if (unclear.empty()) return logs;
  for (const std::size_t i : unclear) {
    const Cluster near = moved_to_mean(directions[i], {logs[i], deviation, 0});
    const bool is_wall = near.weight >= kMinShare * static_cast<double>(directions[i].size());
    if (is_wall)
      estimates[i] = estimate_of(near, errors_of(directions[i], near, row_count).variance);
    else
      estimates[i] = estimate_of(clusters[i], errors[i].variance);
  }
  return smooth_section(estimates);
}

}  // namespace

RobustSection fit_robust_section(std::vector<Direction> directions, std::size_t row_count) {
  remove_scales(directions, row_count);
  RobustSection section{fit_radii(directions, row_count), 0};
  std::vector<double> errors;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (const DistanceSample& sample : directions[i])
      errors.push_back(sample.log - section.radii[i]);
    section.radii[i] = std::exp(section.radii[i]);
  }
  section.spread = deviation_of(std::move(errors));
  return section;
}

}  // namespace strata::mesh
