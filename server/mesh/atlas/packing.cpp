#include "mesh/atlas/packing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "mesh/atlas/canvas.h"
#include "mesh/parallel.h"

namespace strata::mesh {
namespace {

// No single order packs every set of charts best, so several orders are tried. With more charts,
// their results differ less, so fewer orders are tried.
enum Order : std::uint8_t { longer_side, box_area, half_perimeter, area, diagonal };
constexpr std::array<std::uint8_t, 5> kOrders{longer_side, half_perimeter, box_area, diagonal,
                                              area};
constexpr std::size_t kManyCharts = 1000, kSomeCharts = 200;
// Two densities are tried at a time, independent of the number of threads. Each round reduces the
// interval to a third.
constexpr int kTogether = 2;
constexpr int kRounds = 4, kRoundsOfMany = 3;
constexpr double kLikelyFill = 0.78;  // share of the atlas filled by charts with half their gaps
// relative to the atlas; higher packings give no useful estimate
constexpr double kMaxHeight = 1.3;
constexpr double kLessDense = 0.9, kMoreDense = 1.04;

std::vector<std::uint32_t> ordered(std::span<const ChartShape> shapes, std::uint8_t order) {
  const auto size = [&](std::uint32_t i) -> std::int64_t {
    const glm::ivec2 box = shapes[i].box;
    switch (order) {
      case longer_side:
        return std::int64_t{std::max(box.x, box.y)} * 65536 + std::min(box.x, box.y);
      case box_area: return std::int64_t{box.x} * box.y;
      case half_perimeter: return box.x + box.y;
      case diagonal: return std::int64_t{box.x} * box.x + std::int64_t{box.y} * box.y;
      case area: return shapes[i].turned[0].area();
    }
    return 0;
  };
  std::vector<std::uint32_t> numbers(shapes.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  std::stable_sort(numbers.begin(), numbers.end(),
                   [&](auto a, auto b) { return size(a) > size(b); });
  return numbers;
}

// The row where the search for a chart's position begins. No place is free below the position of an
// earlier chart with the same shape. There is rarely free space below the positions of the last
// charts of similar size, or of any size if no chart is similar. With many charts, the search
// assumes that no space is free there. Otherwise it would read the whole atlas for each chart.
class Floors {
 public:
  explicit Floors(std::size_t charts)
      : by_size_(charts >= kSomeCharts), by_any_(charts >= kManyCharts) {
    of_any_.fill(0);
  }

  int of(const ChartMask& mask, std::uint64_t shape) const {
    int floor = 0;
    if (const auto same = of_shape_.find(shape); same != of_shape_.end()) floor = same->second;
    if (!by_size_) return floor;
    const auto like = of_size_.find(size_class(mask));
    if (like != of_size_.end()) return std::max(floor, least(like->second));
    return by_any_ ? std::max(floor, least(of_any_)) : floor;
  }
  // Records a position, whether or not the chart was put there.
  void found(const ChartMask& mask, std::uint64_t shape, int y) {
    of_shape_[shape] = y;
    if (!by_size_) return;
    const auto [last, is_first] = of_size_.try_emplace(size_class(mask));
    if (is_first)
      last->second.fill(by_any_ ? y : 0);
    else
      push(last->second, y);
  }
  void taken(int y) { push(of_any_, y); }

 private:
  static constexpr double kStep = 1.25;  // sizes within this factor are similar
  static std::uint64_t size_class(const ChartMask& mask) {
    const auto step = [](double size) {
      return static_cast<std::uint64_t>(std::log(size) / std::log(kStep));
    };
    return step(mask.width) << 32 | step(mask.height) << 16 |
           step(static_cast<double>(mask.area()));
  }
  static int least(std::span<const int> rows) {
    return *std::min_element(rows.begin(), rows.end());
  }
  static void push(std::span<int> rows, int y) {
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    rows.back() = y;
  }
  const bool by_size_, by_any_;
  std::unordered_map<std::uint64_t, int> of_shape_;
  // three values, so that one chart that is hard to place does not determine the row
  std::unordered_map<std::uint64_t, std::array<int, 3>> of_size_;
  std::array<int, 32> of_any_;
};

std::uint64_t fingerprint(const ChartMask& mask) {
  std::uint64_t hash = 1469598103934665603u;
  const auto add = [&](std::uint64_t value) { hash = (hash ^ value) * 1099511628211u; };
  add(static_cast<std::uint64_t>(mask.width)), add(static_cast<std::uint64_t>(mask.height));
  for (const auto first : mask.first_run) add(first);
  for (const auto& run : mask.runs)
    add(static_cast<std::uint64_t>(run.begin) << 16 | static_cast<std::uint16_t>(run.end));
  return hash;
}

// In texels. A margin of one texel remains on each side.
int longest_box(int side) { return std::max(1, side - 2); }

// The shapes of all charts at one density.
struct Shapes {
  double texels_per_unit = 0;
  std::vector<ChartShape> charts;
  std::vector<std::array<std::uint64_t, 4>> fingerprints;  // of each chart in its four turns
};

// Returns nothing if a shape is larger than the atlas.
std::optional<Shapes> make_shapes(std::span<const Outline> outlines, double density, int side) {
  Shapes shapes;
  shapes.texels_per_unit = density;
  shapes.charts.reserve(outlines.size());
  shapes.fingerprints.reserve(outlines.size());
  for (const Outline& outline : outlines) {
    const ChartShape& shape = shapes.charts.emplace_back(make_shape(outline, density));
    if (std::max(shape.box.x, shape.box.y) > longest_box(side)) return std::nullopt;
    auto& prints = shapes.fingerprints.emplace_back();
    for (std::size_t turn = 0; turn < 4; ++turn) prints[turn] = fingerprint(shape.turned[turn]);
  }
  return shapes;
}

// A packing of charts into a strip as wide as the atlas.
struct Trial {
  Packing packing;
  int height = 0;
};

std::optional<Trial> place(const Shapes& shapes, int side, int most_height, int gap,
                           std::uint8_t order, const Progress& progress) {
  Trial trial;
  trial.packing.texels_per_unit = shapes.texels_per_unit;
  trial.packing.placements.resize(shapes.charts.size());
  Canvas canvas(side, most_height, gap);
  Floors floors(shapes.charts.size());
  for (const auto i : ordered(shapes.charts, order)) {
    if (progress.cancelled()) return std::nullopt;
    const ChartShape& shape = shapes.charts[i];
    const auto& prints = shapes.fingerprints[i];
    Canvas::Spot best;
    int best_turn = 0, best_top = most_height + 1;
    // The turn with a horizontal longer side is tried first. An upright turn reaches the same
    // height only from a much lower position, so the search ends early.
    const int lying = shape.box.x >= shape.box.y ? 0 : 1;
    for (const int turn : {lying, lying + 2, 1 - lying, 3 - lying}) {
      // Small charts often have the same shape in opposite turns.
      if (turn >= 2 && prints[turn] == prints[turn - 2]) continue;
      const ChartMask& mask = shape.turned[turn];
      const auto spot = canvas.find(mask, floors.of(mask, prints[turn]), best_top - mask.height);
      if (spot.x < 0) continue;
      floors.found(mask, prints[turn], spot.y);
      best = spot, best_turn = turn, best_top = spot.y + mask.height;
    }
    if (best.x < 0) return std::nullopt;
    canvas.put(shape.turned[best_turn], best);
    floors.taken(best.y);
    trial.height = std::max(trial.height, best_top + 1);
    trial.packing.placements[i] = {best_turn, {best.x, best.y}, shape.box};
  }
  trial.packing.work = canvas.words_touched();
  return trial;
}

std::span<const std::uint8_t> orders_for(std::size_t charts) {
  return std::span(kOrders).first(charts >= kManyCharts   ? 1
                                  : charts >= kSomeCharts ? 2
                                                          : kOrders.size());
}

double doubled_area(const Outline& outline) {
  double area = 0;
  for (std::size_t i = 0; i + 1 < outline.segments.size(); i += 2) {
    const glm::dvec2 a = outline.segments[i], b = outline.segments[i + 1];
    area += a.x * b.y - a.y * b.x;
  }
  return std::max(area, 0.0);
}

// Returns the density at which the charts, each with half a gap around it, cover `share` of the
// atlas.
double density_that_fills(std::span<const Outline> outlines, int side, int gap, double share) {
  double area = 0, rim = 0;
  for (const Outline& outline : outlines) {
    area += doubled_area(outline) / 2;
    rim += 2 * (double{outline.size.x} + double{outline.size.y});
  }
  const double a = area, b = rim * gap / 2,
               c = double(outlines.size()) * gap * gap / 4 - share * side * side;
  if (a <= 0 && b <= 0) return 1;
  if (c >= 0) return 0;
  return a > 0 ? (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) : -c / b;
}

// Returns a density slightly below the one at which the box of the longest chart would exceed
// `texels`.
double density_of_longest(std::span<const Outline> outlines, int texels) {
  float largest = 0;
  for (const Outline& outline : outlines)
    largest = std::max({largest, outline.size.x, outline.size.y});
  return largest > 0 ? (texels - 2.1 * kNear) / double(largest) : texels;
}

std::optional<Packing> pack_in_orders(std::span<const Outline> outlines, double density, int side,
                                      int gap, std::span<const std::uint8_t> orders,
                                      const Progress& progress) {
  const auto shapes = make_shapes(outlines, density, side);
  if (!shapes) return std::nullopt;
  for (const auto order : orders) {
    auto trial = place(*shapes, side, side, gap, order, progress);
    if (trial) return std::move(trial->packing);
    if (progress.cancelled()) break;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Packing> pack_at(std::span<const Outline> outlines, double texels_per_unit, int side,
                               int gap, const Progress& progress) {
  return pack_in_orders(outlines, texels_per_unit, side, gap, orders_for(outlines.size()),
                        progress);
}

std::optional<PackingStart> begin_packing(std::span<const Outline> outlines, int side, int gap,
                                          const Progress& progress, int threads) {
  const auto texels_each = std::size_t(gap + 1) * std::size_t(gap + 1);
  if (outlines.size() * texels_each > std::size_t(side + gap) * std::size_t(side + gap))
    return std::nullopt;
  const auto orders = orders_for(outlines.size());
  PackingStart start;
  start.least_density = density_of_longest(outlines, 1);
  start.most_density = density_of_longest(outlines, longest_box(side));
  start.density = std::clamp(density_that_fills(outlines, side, gap, kLikelyFill),
                             start.least_density, start.most_density);
  for (;; start.density = std::max(start.density * kLessDense, start.least_density)) {
    std::vector<std::optional<Trial>> trials(orders.size());
    if (const auto shapes = make_shapes(outlines, start.density, side))
      parallel_for(threads, static_cast<int>(orders.size()), [&](int i) {
        trials[i] =
            place(*shapes, side, static_cast<int>(side * kMaxHeight), gap, orders[i], progress);
      });
    if (progress.cancelled()) return std::nullopt;
    std::vector<std::uint8_t> numbers;
    for (std::uint8_t i = 0; i < orders.size(); ++i)
      if (trials[i]) numbers.push_back(i);
    if (numbers.empty() && start.density <= start.least_density) return std::nullopt;
    if (numbers.empty()) continue;
    std::stable_sort(numbers.begin(), numbers.end(),
                     [&](auto a, auto b) { return trials[a]->height < trials[b]->height; });
    Trial& lowest = *trials[numbers.front()];
    for (const auto i : numbers)
      if (start.orders.size() < (outlines.size() >= kSomeCharts ? 2 : 5))
        start.orders.push_back(orders[i]);
    // The height of a packing grows approximately with the area of the charts.
    start.expected_density = std::clamp(start.density * std::sqrt(double(side) / lowest.height),
                                        start.least_density, start.most_density);
    if (lowest.height <= side) start.packing = std::move(lowest.packing);
    return start;
  }
}

std::optional<Packing> finish_packing(std::span<const Outline> outlines, int side, int gap,
                                      PackingStart start, const Progress& progress, int threads) {
  std::optional<Packing> best = std::move(start.packing);
  double low = best ? start.density : std::max(start.least_density, 0.97 * start.expected_density);
  double high = best ? std::min(kMoreDense * start.expected_density, start.most_density)
                     : std::min(start.density, kMoreDense * start.expected_density);
  while (!best) {
    best = pack_in_orders(outlines, low, side, gap, start.orders, progress);
    if (best) break;
    if (low <= start.least_density || progress.cancelled()) return std::nullopt;
    high = low;
    low = std::max(low * 0.97, start.least_density);
  }
  const int rounds = outlines.size() >= kSomeCharts ? kRoundsOfMany : kRounds;
  for (int round = 0; round < rounds && high > low; ++round) {
    std::array<std::optional<Packing>, kTogether> tried;
    const double step = (high - low) / (kTogether + 1);
    parallel_for(threads, kTogether, [&](int i) {
      tried[i] = pack_in_orders(outlines, low + step * (i + 1), side, gap, start.orders, progress);
    });
    if (progress.cancelled()) return std::nullopt;
    int densest = kTogether;
    while (densest > 0 && !tried[densest - 1]) --densest;
    if (densest > 0) best = std::move(tried[densest - 1]);
    if (densest < kTogether) high = low + step * (densest + 1);
    low += step * densest;
  }
  return best;
}

std::optional<Packing> pack_densely(std::span<const Outline> outlines, int side, int gap,
                                    const Progress& progress, int threads) {
  auto start = begin_packing(outlines, side, gap, progress, threads);
  if (!start) return std::nullopt;
  return finish_packing(outlines, side, gap, std::move(*start), progress, threads);
}

}  // namespace strata::mesh
