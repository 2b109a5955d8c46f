#include "mesh/packing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "mesh/canvas.h"
#include "mesh/parallel.h"

namespace strata::mesh {
namespace {

// No single order packs every set of charts best; the first that fits a density is taken.
enum class Order { longer_side, box_area, half_perimeter, area, diagonal };
constexpr std::array kOrders{Order::longer_side, Order::half_perimeter, Order::box_area, Order::diagonal, Order::area};
constexpr std::size_t kManyCharts = 3000;  // from here on one order has to do
// Densities are tried two at a time, whatever the number of threads: each round leaves a third of the interval.
constexpr int kTogether = 2;
constexpr int kRounds = 4;
constexpr double kLeastFill = 0.62, kMostFill = 0.95;  // of the atlas by charts with half their gaps

std::vector<std::uint32_t> ordered(std::span<const ChartShape> shapes, Order order) {
  const auto size = [&](std::uint32_t i) -> std::int64_t {
    const glm::ivec2 box = shapes[i].box;
    switch (order) {
      case Order::longer_side: return std::int64_t{std::max(box.x, box.y)} * 65536 + std::min(box.x, box.y);
      case Order::box_area: return std::int64_t{box.x} * box.y;
      case Order::half_perimeter: return box.x + box.y;
      case Order::diagonal: return std::int64_t{box.x} * box.x + std::int64_t{box.y} * box.y;
      case Order::area: return shapes[i].turned[0].area();
    }
    return 0;
  };
  std::vector<std::uint32_t> numbers(shapes.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  std::stable_sort(numbers.begin(), numbers.end(), [&](auto a, auto b) { return size(a) > size(b); });
  return numbers;
}

std::optional<std::vector<Placement>> place(std::span<const ChartShape> shapes, int side, int gap, Order order,
                                            const Progress& progress) {
  std::vector<Placement> placements(shapes.size());
  Canvas canvas(side, gap);
  // Nothing is free below where a chart of the very same shape found its place.
  std::map<std::pair<int, int>, int> lowest_of_box;
  const bool is_exact = shapes.size() < kManyCharts;
  for (const auto i : ordered(shapes, order)) {
    if (progress.cancelled()) return std::nullopt;
    const ChartShape& shape = shapes[i];
    Canvas::Spot best;
    int best_turn = 0, best_top = side + 1;
    for (int turn = 0; turn < 4; ++turn) {
      const ChartMask& mask = shape.turned[turn];
      // Small charts look the same from most sides.
      if (std::find(shape.turned.begin(), shape.turned.begin() + turn, mask) != shape.turned.begin() + turn) continue;
      const bool is_box = mask.runs.size() == static_cast<std::size_t>(mask.height) &&
                          std::all_of(mask.runs.begin(), mask.runs.end(),
                                      [&](const auto& run) { return run.begin == 0 && run.end == mask.width; });
      int& lowest = lowest_of_box[{mask.width, mask.height}];
      const int from = is_box || !is_exact ? lowest : 0;
      const auto spot = canvas.find(mask, from, best_top - mask.height);
      if (spot.x < 0) continue;
      if (is_box || !is_exact) lowest = spot.y;
      best = spot, best_turn = turn, best_top = spot.y + mask.height;
    }
    if (best.x < 0) return std::nullopt;
    canvas.put(shape.turned[best_turn], best);
    placements[i] = {best_turn, {best.x, best.y}, shape.box};
  }
  return placements;
}

double doubled_area(const Outline& outline) {
  double area = 0;
  for (std::size_t i = 0; i + 1 < outline.segments.size(); i += 2) {
    const glm::dvec2 a = outline.segments[i], b = outline.segments[i + 1];
    area += a.x * b.y - a.y * b.x;
  }
  return std::max(area, 0.0);
}

// The density at which the charts, each with half a gap around it, take `share` of the atlas.
double density_that_fills(std::span<const Outline> outlines, int side, int gap, double share) {
  double area = 0, rim = 0;
  for (const Outline& outline : outlines) {
    area += doubled_area(outline) / 2;
    rim += 2 * (double{outline.size.x} + double{outline.size.y});
  }
  const double a = area, b = rim * gap / 2, c = double(outlines.size()) * gap * gap / 4 - share * side * side;
  if (a <= 0 && b <= 0) return 1;
  if (c >= 0) return 0;
  return a > 0 ? (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) : -c / b;
}

// A density at which every chart is a single texel: there is no use in one below.
double least_density(std::span<const Outline> outlines) {
  float largest = 0;
  for (const Outline& outline : outlines) largest = std::max({largest, outline.size.x, outline.size.y});
  return largest > 0 ? 0.999 / double(largest) : 1;
}

}  // namespace

std::optional<Packing> pack_at(std::span<const Outline> outlines, double texels_per_unit, int side, int gap,
                               const Progress& progress) {
  std::vector<ChartShape> shapes;
  shapes.reserve(outlines.size());
  for (const Outline& outline : outlines) {
    if (std::max(outline.size.x, outline.size.y) * texels_per_unit >= side) return std::nullopt;
    shapes.push_back(make_shape(outline, texels_per_unit));
  }
  for (const Order order : kOrders) {
    auto placements = place(shapes, side, gap, order, progress);
    if (placements) return Packing{texels_per_unit, std::move(*placements)};
    if (outlines.size() >= kManyCharts || progress.cancelled()) break;
  }
  return std::nullopt;
}

std::optional<Packing> pack_densely(std::span<const Outline> outlines, int side, int gap, const Progress& progress,
                                    int threads) {
  const auto texels_each = std::size_t(gap + 1) * std::size_t(gap + 1);
  if (outlines.size() * texels_each > std::size_t(side + gap) * std::size_t(side + gap)) return std::nullopt;
  const double least = least_density(outlines);
  double high = std::max(least, density_that_fills(outlines, side, gap, kMostFill));
  double low = std::clamp(density_that_fills(outlines, side, gap, kLeastFill), least, high);
  std::optional<Packing> best = pack_at(outlines, low, side, gap, progress);
  while (!best) {
    if (low <= least || progress.cancelled()) return std::nullopt;
    high = low;
    low = std::max(low * 0.9, least);
    best = pack_at(outlines, low, side, gap, progress);
  }
  for (int round = 0; round < kRounds; ++round) {
    std::array<std::optional<Packing>, kTogether> tried;
    const double step = (high - low) / (kTogether + 1);
    parallel_for(threads, kTogether,
                 [&](int i) { tried[i] = pack_at(outlines, low + step * (i + 1), side, gap, progress); });
    if (progress.cancelled()) return std::nullopt;
    int densest = kTogether;
    while (densest > 0 && !tried[densest - 1]) --densest;
    if (densest > 0) best = std::move(tried[densest - 1]);
    if (densest < kTogether) high = low + step * (densest + 1);
    low += step * densest;
  }
  return best;
}

}  // namespace strata::mesh
