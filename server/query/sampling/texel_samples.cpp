#include "query/sampling/texel_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/compensated_sum.h"
#include "query/statistics/value_classes.h"

namespace strata::query {
namespace {

using Cell = std::array<std::int64_t, 3>;  // z, y, x

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t index : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15ull;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

struct CellSum {
  CompensatedSum area_m2, weight, weighted_value;
  // range of the values
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  glm::dvec3 weighted_position{0};
  std::vector<std::pair<std::uint32_t, double>> keys;  // one cell has only a few keys
};

// Texels without an area have an effect only if the cell has no other texels.
double weight_of(const TexelSample& sample) { return std::max(sample.area_m2, 1e-200); }

void add_key(CellSum& sum, std::uint32_t bits, double weight) {
  const auto found = std::ranges::find(sum.keys, bits, [](const auto& key) { return key.first; });
  if (found == sum.keys.end())
    sum.keys.emplace_back(bits, weight);
  else
    found->second += weight;
}

std::uint32_t largest_key(const CellSum& sum) {
  return std::ranges::max_element(sum.keys,
                                  [](const auto& a, const auto& b) {
                                    return a.second != b.second ? a.second < b.second
                                                                : a.first > b.first;
                                  })
      ->first;
}

}  // namespace

Result<std::vector<TexelSample>> samples_by_cell(const SurfaceTexels& texels, double edge) {
  const bool has_keys = classes_of(texels.view.layer).each;
  const QuestionTurn turn;
  std::unordered_map<Cell, CellSum, CellHash> cells;
  bool countable = true;
  for_each_sample(texels, [&](const TexelSample& sample) {
    const glm::dvec3 index = glm::floor(sample.position / edge);
    // false for NaN and infinity, too
    for (int axis = 0; axis < 3; ++axis) countable &= std::abs(index[axis]) < 1e15;
    if (!countable) return false;
    CellSum& sum = cells[{static_cast<std::int64_t>(index.z), static_cast<std::int64_t>(index.y),
                          static_cast<std::int64_t>(index.x)}];
    const double weight = weight_of(sample);
    sum.area_m2 += sample.area_m2;
    sum.weight += weight;
    sum.weighted_value += weight * sample.value;
    sum.lowest = std::min(sum.lowest, sample.value);
    sum.highest = std::max(sum.highest, sample.value);
    sum.weighted_position += weight * (sample.position - texels.origin);
    if (has_keys) add_key(sum, sample.bits, weight);
    return cells.size() <= kMaxCells;
  });
  if (!countable || cells.size() > kMaxCells)
    return fail(ErrorCode::invalid, "Cells too small",
                "The surface has more than " + std::to_string(kMaxCells) +
                    " cells of this size. Choose larger cells.",
                "cell");
  std::vector<Cell> order;
  order.reserve(cells.size());
  for (const auto& [cell, sum] : cells) order.push_back(cell);
  std::ranges::sort(order);
  std::vector<TexelSample> samples;
  samples.reserve(order.size());
  for (const Cell& cell : order) {
    const CellSum& sum = cells.at(cell);
    const double weight = sum.weight.value();
    TexelSample sample{texels.origin + sum.weighted_position / weight, sum.area_m2.value(), 0,
                       std::clamp(sum.weighted_value.value() / weight, sum.lowest, sum.highest)};
    if (has_keys) {
      sample.bits = largest_key(sum);
      sample.value = decode_value(texels.view.layer.type, sample.bits);
    }
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace strata::query
