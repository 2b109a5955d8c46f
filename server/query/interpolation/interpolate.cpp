#include "query/interpolation/interpolate.h"

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "core/text/number_text.h"
#include "mesh/parallel.h"
#include "mesh/texels/texel_graph.h"
#include "query/interpolation/matern_field.h"
#include "query/interpolation/readings.h"
#include "query/interpolation/surface_cells.h"
#include "query/regions/neighborhood_limits.h"
#include "query/regions/texel_discs.h"

namespace strata::query {
namespace {

constexpr double kNoiseShare = 0.01;
constexpr std::size_t kMaxCells = 50'000;
// The covariances between cells and readings take 8 bytes each.
constexpr std::size_t kMaxCovariances = 10'000'000;
// The range in spacings of cells. More cells are more exact, fewer are faster.
constexpr double kFinestCells = 14, kMediumCells = 9, kCoarsestCells = 5;
// The area of a cell is at least about this much of the square of the spacing.
constexpr double kCellArea = 0.8;
// In a spacing, so that borders of cells are well measured.
constexpr double kLeastTexels = kMinRangeTexels / kCoarsestCells;

std::size_t max_cells(std::size_t readings) {
  return std::min(kMaxCells, kMaxCovariances / readings);
}

tl::unexpected<Error> refuse(const std::string& title, const std::string& detail,
                             const std::string& field) {
  return fail(ErrorCode::invalid, title, detail, field);
}

// Returns a positive number with two digits, rounded up or down.
std::string rounded(double number, double (*round)(double)) {
  const double unit = std::pow(10, std::floor(std::log10(number)) - 1);
  return short_number(round(number / unit) * unit);
}

double diagonal_of(const mesh::SurfaceMap& map) {
  glm::vec3 lowest{std::numeric_limits<float>::infinity()}, highest = -lowest;
  for (const auto& sums : map.sums_of_slot) {
    lowest = glm::min(lowest, sums.lowest);
    highest = glm::max(highest, sums.highest);
  }
  return glm::distance(glm::dvec3(lowest), glm::dvec3(highest));
}

tl::unexpected<Error> range_too_small(double range, const mesh::SurfaceMap& map,
                                      std::size_t readings, const std::string& field) {
  // Narrow pieces have more cells than their area suggests.
  constexpr double kMore = 1.25;
  const double least = std::max(
      kMore * range,
      kCoarsestCells * std::sqrt(map.area_total / (kCellArea * double(max_cells(readings)))));
  return refuse("Range too small",
                "With " + std::to_string(readings) +
                    " readings on this surface, choose a range of " + rounded(least, std::ceil) +
                    " model units or more.",
                field);
}

Result<std::vector<Reading>> checked_readings(const SurfaceValues& values, ValueType type,
                                              const mesh::SurfaceMap& map,
                                              const mesh::TexelGraph& graph,
                                              const std::string& field, const Progress& progress) {
  auto readings = STRATA_TRY(find_readings(values, type, map, graph, kMaxReadings, progress));
  if (readings.size() > kMaxReadings)
    return refuse("Too many readings",
                  "There are more than " + std::to_string(kMaxReadings) +
                      " readings. Each connected area of one value is a reading. Paint each "
                      "reading as a spot of one value, or round the values, for example "
                      "`round(moisture * 10) / 10`.",
                  field);
  if (readings.size() < kMinReadings)
    return refuse("Too few readings",
                  "Readings found: " + std::to_string(readings.size()) + ". At least " +
                      std::to_string(kMinReadings) +
                      " are needed. Each connected area of one value is a reading. Ten or more "
                      "readings give useful errors.",
                  field);
  return readings;
}

Result<SurfaceCells> cells_for(const std::vector<Reading>& readings, double range,
                               const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                               const std::string& field, const Progress& progress) {
  const double least = kLeastTexels * mean_texel_size(map);
  std::vector<std::uint32_t> starts;
  for (const Reading& reading : readings) starts.push_back(reading.texels.front());
  for (const double cells_in_range : {kFinestCells, kMediumCells, kCoarsestCells}) {
    const double spacing = std::max(range / cells_in_range, least);
    if (spacing * kCoarsestCells > range) break;
    auto cells = STRATA_TRY(
        make_surface_cells(map, graph, starts, spacing, max_cells(readings.size()), progress));
    if (cells) return std::move(*cells);
  }
  return range_too_small(range, map, readings.size(), field);
}

// The means over spots as weights of cells.
class SpotWeights {
 public:
  SpotWeights(const SurfaceCells& cells, const mesh::SurfaceMap& map)
      : cells_(cells), map_(map), weights_(cells.count(), 0), is_touched_(cells.count(), false) {}

  // Fails when cancelled.
  Result<Eigen::SparseVector<double>> of(const Reading& reading, const Progress& progress) {
    // Some texels have no area of their own, and a spot may consist of them.
    const double least_area = 1e-6 * cells_.spacing * cells_.spacing;
    double area = 0;
    constexpr std::size_t kTexelsAtOnce = 4096;
    for (std::size_t i = 0; i < reading.texels.size(); ++i) {
      if (i % kTexelsAtOnce == 0 && progress.cancelled()) return cancelled_problem();
      const std::uint32_t texel = reading.texels[i];
      const double of_texel = std::max(double{map_.area[texel]}, least_area);
      area += of_texel;
      add(texel, of_texel);
    }
    std::ranges::sort(touched_);
    Eigen::SparseVector<double> result(static_cast<Eigen::Index>(cells_.count()));
    for (const std::uint32_t cell : touched_) {
      result.insert(static_cast<Eigen::Index>(cell)) = weights_[cell] / area;
      weights_[cell] = 0;
      is_touched_[cell] = false;
    }
    touched_.clear();
    return result;
  }

 private:
  void add(std::uint32_t texel, double area) {
    const glm::dvec3 at(map_.position(texel / 64, static_cast<int>(texel % 64)));
    cells_.for_each_weight(cells_.of_texel[texel], at,
                           [&](std::uint32_t cell, double weight, glm::dvec3 offset) {
                             add_to_cell(cell, area * weight);
                             for (const auto& side : cells_.sides_of(cell)) {
                               const double share = area * weight * glm::dot(side.gradient, offset);
                               add_to_cell(side.other, share);
                               add_to_cell(cell, -share);
                             }
                           });
  }
  void add_to_cell(std::uint32_t cell, double weight) {
    weights_[cell] += weight;
    if (!is_touched_[cell]) touched_.push_back(cell);
    is_touched_[cell] = true;
  }

  const SurfaceCells& cells_;
  const mesh::SurfaceMap& map_;
  std::vector<double> weights_;
  std::vector<bool> is_touched_;
  std::vector<std::uint32_t> touched_;
};

// The covariances of the field with the readings, in units of the sill.
struct Covariances {
  Eigen::MatrixXd of_cells;     // cells × readings
  Eigen::MatrixXd of_readings;  // with the noise
};

Result<Covariances> find_covariances(const MaternField& field,
                                     const std::vector<Eigen::SparseVector<double>>& spots,
                                     std::size_t cells, Progress& progress, int threads) {
  const auto count = static_cast<Eigen::Index>(spots.size());
  Covariances result{{static_cast<Eigen::Index>(cells), count}, {count, count}};
  std::atomic<int> done{0};
  mesh::parallel_for(threads, static_cast<int>(count), [&](int reading) {
    if (progress.cancelled()) return;
    result.of_cells.col(reading) =
        field.covariance_times(Eigen::VectorXd(spots[static_cast<std::size_t>(reading)]));
    for (Eigen::Index other = 0; other <= reading; ++other)
      result.of_readings(reading, other) =
          spots[static_cast<std::size_t>(other)].dot(result.of_cells.col(reading));
    result.of_readings(reading, reading) += kNoiseShare;
    progress.report(0.2 + 0.4 * double(++done) / double(count), "Comparing readings");
  });
  if (progress.cancelled()) return cancelled_problem();
  return result;
}

// The estimates from all readings.
struct Estimate {
  Eigen::LLT<Eigen::MatrixXd> factor;  // of the covariances of the readings; its lower half is used
  Eigen::VectorXd weights;             // of the covariances with a place, in its expected value
  Eigen::VectorXd of_ones;             // the inverse covariances times 1
  double mean = 0, mean_variance = 0, sill = 0;  // the variance in units of the sill
};

Estimate estimate(const Eigen::MatrixXd& of_readings, const std::vector<Reading>& readings) {
  const auto count = static_cast<Eigen::Index>(readings.size());
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i) values[i] = readings[static_cast<std::size_t>(i)].value;
  Estimate result;
  result.factor.compute(of_readings);
  result.of_ones = result.factor.solve(Eigen::VectorXd::Ones(count));
  result.mean_variance = 1 / result.of_ones.sum();
  result.mean = result.of_ones.dot(values) * result.mean_variance;
  const Eigen::VectorXd rest = values.array() - result.mean;
  result.weights = result.factor.solve(rest);
  result.sill = rest.dot(result.weights) / double(count - 1);
  return result;
}

// Returns the variances at the cells, in units of the sill.
Result<std::vector<double>> variances_of(const Covariances& covariances, const Estimate& found,
                                         Progress& progress, int threads) {
  constexpr Eigen::Index kCellsAtOnce = 256;
  const Eigen::Index cells = covariances.of_cells.rows();
  const Eigen::Index parts = (cells + kCellsAtOnce - 1) / kCellsAtOnce;
  std::vector<double> variances(static_cast<std::size_t>(cells));
  std::atomic<int> done{0};
  mesh::parallel_for(threads, static_cast<int>(parts), [&](int part) {
    if (progress.cancelled()) return;
    const Eigen::Index first = part * kCellsAtOnce, count = std::min(kCellsAtOnce, cells - first);
    Eigen::MatrixXd known = covariances.of_cells.middleRows(first, count).transpose();
    const Eigen::VectorXd of_mean = 1 - (known.transpose() * found.of_ones).array();
    found.factor.matrixL().solveInPlace(known);
    for (Eigen::Index i = 0; i < count; ++i)
      variances[static_cast<std::size_t>(first + i)] = std::max(
          0.0, 1 - known.col(i).squaredNorm() + of_mean[i] * of_mean[i] * found.mean_variance);
    progress.report(0.6 + 0.3 * double(++done) / double(parts), "Estimating errors");
  });
  if (progress.cancelled()) return cancelled_problem();
  return variances;
}

// Calls value_at(cell of the texel, its position) for each texel in a cell. Numbers that are not
// finite in single precision become no value. Fails when cancelled.
template <class ValueAt>
Result<SurfaceValues> values_of_texels(const SurfaceCells& cells, const mesh::SurfaceMap& map,
                                       const Progress& progress, int threads, ValueAt value_at) {
  constexpr std::size_t kSlotsAtOnce = 1024;
  const std::size_t slots = map.block_of_slot.size();
  SurfaceValues result{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  const std::size_t parts = (slots + kSlotsAtOnce - 1) / kSlotsAtOnce;
  mesh::parallel_for(threads, static_cast<int>(parts), [&](int part) {
    if (progress.cancelled()) return;
    const std::size_t first = static_cast<std::size_t>(part) * kSlotsAtOnce;
    for (std::size_t slot = first; slot < std::min(slots, first + kSlotsAtOnce); ++slot)
      for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        const auto texel = static_cast<std::uint32_t>(slot * 64 + static_cast<std::size_t>(i));
        const std::uint32_t cell = cells.of_texel[texel];
        if (cell == kNoCell) continue;
        const auto value = static_cast<float>(
            value_at(cell, glm::dvec3(map.position(static_cast<std::uint32_t>(slot), i))));
        if (std::isfinite(value)) result.set(texel, {std::bit_cast<std::uint32_t>(value), true});
      }
  });
  if (progress.cancelled()) return cancelled_problem();
  return result;
}

std::vector<glm::dvec3> gradients_of(const SurfaceCells& cells, std::span<const double> values) {
  std::vector<glm::dvec3> gradients(cells.count(), glm::dvec3(0));
  for (std::uint32_t cell = 0; cell < cells.count(); ++cell)
    for (const auto& side : cells.sides_of(cell))
      gradients[cell] += side.gradient * (values[side.other] - values[cell]);
  return gradients;
}

Result<SurfaceValues> means_at_texels(const SurfaceCells& cells, const mesh::SurfaceMap& map,
                                      std::span<const double> means, const Progress& progress,
                                      int threads) {
  const auto gradients = gradients_of(cells, means);
  return values_of_texels(cells, map, progress, threads, [&](std::uint32_t own, glm::dvec3 at) {
    double mean = 0;
    cells.for_each_weight(own, at, [&](std::uint32_t cell, double weight, glm::dvec3 offset) {
      mean += weight * (means[cell] + glm::dot(gradients[cell], offset));
    });
    return mean;
  });
}

// Variances between cells are within those of the cells, so that none is below 0.
Result<SurfaceValues> errors_at_texels(const SurfaceCells& cells, const mesh::SurfaceMap& map,
                                       std::span<const double> variances, double sill,
                                       const Progress& progress, int threads) {
  const auto gradients = gradients_of(cells, variances);
  return values_of_texels(cells, map, progress, threads, [&](std::uint32_t own, glm::dvec3 at) {
    double variance = 0, lowest = variances[own], highest = lowest;
    cells.for_each_weight(own, at, [&](std::uint32_t cell, double weight, glm::dvec3 offset) {
      variance += weight * (variances[cell] + glm::dot(gradients[cell], offset));
      lowest = std::min(lowest, variances[cell]);
      highest = std::max(highest, variances[cell]);
    });
    return std::sqrt(sill * std::clamp(variance, lowest, highest));
  });
}

}  // namespace

Result<SurfaceValues> interpolated_values(Interpolated what, const SurfaceValues& values,
                                          ValueType type, double range, const mesh::SurfaceMap& map,
                                          const mesh::TexelGraph& graph, const std::string& field,
                                          Progress& progress, int threads) {
  STRATA_TRY(check_interpolation_range(range, mean_texel_size(map), field));
  progress.report(0, "Finding readings");
  const auto readings = STRATA_TRY(checked_readings(values, type, map, graph, field, progress));
  if (const double longest = kMaxRangeDiagonals * diagonal_of(map); !(range <= longest))
    return refuse("Range too large",
                  "Choose a range of " + rounded(longest, std::floor) +
                      " model units or less. With a larger one, the readings could hardly differ.",
                  field);
  const SurfaceCells cells = STRATA_TRY(cells_for(readings, range, map, graph, field, progress));
  progress.report(0.1, "Comparing readings");
  const MaternField matern = STRATA_TRY(MaternField::make(cells, range, progress, threads));
  SpotWeights weights(cells, map);
  std::vector<Eigen::SparseVector<double>> spots;
  for (const Reading& reading : readings)
    spots.push_back(STRATA_TRY(weights.of(reading, progress)));
  const Covariances covariances =
      STRATA_TRY(find_covariances(matern, spots, cells.count(), progress, threads));
  const Estimate found = estimate(covariances.of_readings, readings);
  if (what == Interpolated::mean) {
    const Eigen::VectorXd means = (covariances.of_cells * found.weights).array() + found.mean;
    return means_at_texels(cells, map, std::span(means.data(), cells.count()), progress, threads);
  }
  if (std::ranges::all_of(readings, [&](const Reading& reading) {
        return reading.value == readings.front().value;
      }))
    return refuse("Readings are all equal",
                  "All readings have the same value, so their variation and the error of the "
                  "interpolation cannot be estimated.",
                  field);
  const auto variances = STRATA_TRY(variances_of(covariances, found, progress, threads));
  return errors_at_texels(cells, map, variances, found.sill, progress, threads);
}

}  // namespace strata::query
