#include "mesh/packing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "mesh/adjacency.h"

namespace strata::mesh {
namespace {

constexpr int kEdgeMargin = 1;  // texels kept free along the rim of the atlas

// Lowest and highest texel that a chart touches in each column.
struct Profile {
  std::vector<std::int16_t> bottom, top;
  int width() const { return static_cast<int>(bottom.size()); }
  bool operator==(const Profile&) const = default;
};

// No single rule packs every set of charts best; each is quick, so several are tried.
enum class Order { longer_side, box_area, perimeter };
struct Strategy {
  Order order;
  int waste_weight;   // of texels lost below a chart
  int height_weight;  // of the height at which a chart's top lies, per column
};
constexpr std::array<Strategy, 6> kStrategies{{{Order::longer_side, 2, 1},
                                               {Order::box_area, 2, 1},
                                               {Order::longer_side, 1, 1},
                                               {Order::perimeter, 4, 1},
                                               {Order::box_area, 1, 1},
                                               {Order::longer_side, 1, 0}}};
constexpr std::size_t kManyCharts = 3000;  // from here on one strategy has to do

struct Shape {
  glm::ivec2 box{1};
  std::array<Profile, 4> turned;  // by quarter turns
};

void widen(Profile& profile, int column, double low, double high) {
  profile.bottom[column] = std::min<std::int16_t>(profile.bottom[column], static_cast<std::int16_t>(std::floor(low)));
  profile.top[column] = std::max<std::int16_t>(profile.top[column], static_cast<std::int16_t>(std::floor(high)));
}

// Marks the texels a segment touches, column by column of the first coordinate.
void add_segment(Profile& profile, glm::dvec2 a, glm::dvec2 b) {
  if (a.x > b.x) std::swap(a, b);
  const int first = static_cast<int>(a.x), last = std::min(static_cast<int>(b.x), profile.width() - 1);
  const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0;
  for (int column = first; column <= last; ++column) {
    const double from = std::max<double>(a.x, column), to = std::min<double>(b.x, column + 1);
    double y0 = a.y + slope * (from - a.x), y1 = a.y + slope * (to - a.x);
    if (column == first) y0 = a.y;
    if (to >= b.x) y1 = b.y;
    widen(profile, column, std::min(y0, y1), std::max(y0, y1));
  }
}

Profile mirrored(const Profile& profile, int height) {
  Profile result = profile;
  const int width = profile.width();
  for (int i = 0; i < width; ++i) {
    result.bottom[i] = static_cast<std::int16_t>(height - 1 - profile.top[width - 1 - i]);
    result.top[i] = static_cast<std::int16_t>(height - 1 - profile.bottom[width - 1 - i]);
  }
  return result;
}

Profile reversed(Profile profile) {
  std::reverse(profile.bottom.begin(), profile.bottom.end());
  std::reverse(profile.top.begin(), profile.top.end());
  return profile;
}

// Columns that no segment touched (only rounding leaves any) count as full.
void fill_untouched(Profile& profile, int height) {
  for (int i = 0; i < profile.width(); ++i)
    if (profile.top[i] < 0) profile.bottom[i] = 0, profile.top[i] = static_cast<std::int16_t>(height - 1);
}

Shape make_shape(const Outline& outline, double density) {
  Shape shape;
  shape.box = glm::ivec2(glm::floor(glm::dvec2(outline.size) * density)) + 1;
  Profile columns, rows;
  columns.bottom.assign(shape.box.x, std::numeric_limits<std::int16_t>::max());
  columns.top.assign(shape.box.x, -1);
  rows.bottom.assign(shape.box.y, std::numeric_limits<std::int16_t>::max());
  rows.top.assign(shape.box.y, -1);
  const glm::dvec2 largest = glm::dvec2(shape.box) - 1e-9;
  for (std::size_t i = 0; i + 1 < outline.segments.size(); i += 2) {
    const glm::dvec2 a = glm::clamp(glm::dvec2(outline.segments[i]) * density, glm::dvec2(0), largest);
    const glm::dvec2 b = glm::clamp(glm::dvec2(outline.segments[i + 1]) * density, glm::dvec2(0), largest);
    add_segment(columns, a, b);
    add_segment(rows, {a.y, a.x}, {b.y, b.x});
  }
  fill_untouched(columns, shape.box.y);
  fill_untouched(rows, shape.box.x);
  // A quarter turn sends (x, y) to (height - y, x): its columns are the rows from the top down.
  shape.turned[0] = columns;
  shape.turned[1] = reversed(rows);
  shape.turned[2] = mirrored(columns, shape.box.y);
  shape.turned[3] = mirrored(shape.turned[1], shape.box.x);
  return shape;
}

// For each column how high the atlas is filled, with `gap` columns of air at both ends.
class Skyline {
 public:
  Skyline(int side, int gap)
      : side_(side),
        gap_(gap),
        heights_(static_cast<std::size_t>(side) + 2 * gap + kColumnsAtOnce,
                 static_cast<std::int16_t>(kEdgeMargin - gap)) {}

  struct Spot {
    int x = -1, y = 0;
    std::int64_t cost = std::numeric_limits<std::int64_t>::max();
  };

  // The place with the least cost of waste below the chart and height.
  Spot find(const Profile& profile, int height, const Strategy& strategy) {
    const int width = profile.width(), reach = width + 2 * gap_;
    Spot best;
    if (width + 2 * kEdgeMargin > side_ || height + 2 * kEdgeMargin > side_) return best;
    // What lies within `gap` columns must stay `gap` texels below.
    floor_.assign(reach, 0);
    std::int64_t bottom_sum = 0;
    for (int i = 0; i < reach; ++i) {
      std::int16_t lowest = std::numeric_limits<std::int16_t>::max();
      for (int j = std::max(0, i - 2 * gap_); j <= std::min(width - 1, i); ++j)
        lowest = std::min(lowest, profile.bottom[j]);
      floor_[i] = static_cast<std::int16_t>(lowest - gap_);
      bottom_sum += floor_[i];
    }
    const auto* first = heights_.data() + kEdgeMargin;
    std::int64_t filled = std::accumulate(first, first + reach, std::int64_t{0});  // of the columns below the chart
    Columns lowest;
    for (int x = kEdgeMargin; x + width + kEdgeMargin <= side_; ++x) {
      const int column = (x - kEdgeMargin) % kColumnsAtOnce;
      if (column == 0) lowest = lowest_places(x);
      const std::int16_t* line = heights_.data() + x;  // heights_ begins gap columns left of column 0
      if (x > kEdgeMargin) filled += line[reach - 1] - line[-1];
      const std::int16_t y = lowest[column];
      if (y + height + kEdgeMargin > side_) continue;
      const std::int64_t waste = std::int64_t{y} * reach + bottom_sum - filled;
      const std::int64_t cost =
          strategy.waste_weight * waste + strategy.height_weight * std::int64_t{y + height} * width;
      if (cost < best.cost) best = {x, y, cost};
    }
    return best;
  }

  void put(const Profile& profile, const Spot& spot) {
    for (int i = 0; i < profile.width(); ++i)
      heights_[spot.x + gap_ + i] = static_cast<std::int16_t>(spot.y + profile.top[i] + 1);
  }

 private:
  static constexpr int kColumnsAtOnce = 64;
  using Columns = std::array<std::int16_t, kColumnsAtOnce>;

  // The lowest y, for x and the columns after it, at which a chart with this `floor_` clears what lies there. The inner
  // loop has a fixed length: compilers make vectors of it.
  Columns lowest_places(int x) const {
    Columns lowest;
    lowest.fill(std::numeric_limits<std::int16_t>::min());
    for (std::size_t i = 0; i < floor_.size(); ++i) {
      const std::int16_t* line = heights_.data() + x + i;
      for (int k = 0; k < kColumnsAtOnce; ++k) {
        const auto needed = static_cast<std::int16_t>(line[k] - floor_[i]);
        lowest[k] = needed > lowest[k] ? needed : lowest[k];
      }
    }
    return lowest;
  }

  const int side_, gap_;
  std::vector<std::int16_t> heights_;  // and some columns more, so that whole runs can be read
  std::vector<std::int16_t> floor_;    // of the chart that is looked for, relative to its y
};

}  // namespace

std::vector<Outline> make_outlines(const ChartSurface& surface, std::span<const Chart> charts) {
  constexpr int kAngles = 32;
  std::vector<std::uint32_t> chart_of_face(surface.mesh.triangle_count(), 0);
  for (std::size_t c = 0; c < charts.size(); ++c)
    for (const auto face : charts[c].faces) chart_of_face[face] = static_cast<std::uint32_t>(c);
  std::vector<Outline> outlines(charts.size());
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const Chart& chart = charts[c];
    Outline& outline = outlines[c];
    for (const auto face : chart.faces)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t next = surface.neighbours[3 * face + k];
        if (next != kNoTriangle && chart_of_face[next] == c) continue;
        outline.segments.push_back(chart.project(surface.corner(chart, face, k)));
        outline.segments.push_back(chart.project(surface.corner(chart, face, (k + 1) % 3)));
      }
    float least = std::numeric_limits<float>::max();
    Outline best;
    for (int step = 0; step < kAngles; ++step) {
      const float angle = glm::radians(90.f) * static_cast<float>(step) / kAngles;
      Outline turned;
      turned.cosine = std::cos(angle), turned.sine = std::sin(angle);
      glm::vec2 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
      for (const auto& p : outline.segments) {
        const glm::vec2 q = turned.from_chart(p);
        low = glm::min(low, q), high = glm::max(high, q);
      }
      turned.low = low, turned.size = high - low;
      if (const float area = turned.size.x * turned.size.y; area < least) least = area, best = turned;
    }
    for (auto& p : outline.segments) p = best.from_chart(p);
    best.segments = std::move(outline.segments);
    outline = std::move(best);
  }
  return outlines;
}

namespace {

// All shapes at this density; empty where they cannot fit whatever the order.
std::optional<std::vector<Shape>> make_shapes(std::span<const Outline> outlines, double texels_per_unit, int side,
                                              int gap) {
  std::vector<Shape> shapes;
  shapes.reserve(outlines.size());
  std::int64_t least_area = 0;
  for (const Outline& outline : outlines) {
    const glm::dvec2 size = glm::dvec2(outline.size) * texels_per_unit;
    if (std::max(size.x, size.y) + 2 * kEdgeMargin + 1 > side) return std::nullopt;
    shapes.push_back(make_shape(outline, texels_per_unit));
    const Profile& columns = shapes.back().turned[0];
    for (int i = 0; i < columns.width(); ++i) least_area += columns.top[i] - columns.bottom[i] + 1 + gap;
    if (least_area > std::int64_t{side} * (side + gap)) return std::nullopt;
  }
  return shapes;
}

std::vector<std::uint32_t> ordered(std::span<const Shape> shapes, Order order) {
  const auto size_of = [&](std::uint32_t i) -> std::int64_t {
    const glm::ivec2 box = shapes[i].box;
    switch (order) {
      case Order::box_area: return std::int64_t{box.x} * box.y;
      case Order::perimeter: return box.x + box.y;
      default: return std::max(box.x, box.y);
    }
  };
  std::vector<std::uint32_t> result(shapes.size());
  std::iota(result.begin(), result.end(), 0u);
  std::stable_sort(result.begin(), result.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return size_of(a) > size_of(b); });
  return result;
}

std::optional<std::vector<Placement>> place(std::span<const Shape> shapes, int side, int gap, const Strategy& strategy,
                                            const Progress& progress) {
  std::vector<Placement> placements(shapes.size());
  Skyline skyline(side, gap);
  for (const auto i : ordered(shapes, strategy.order)) {
    if (progress.cancelled()) return std::nullopt;
    const Shape& shape = shapes[i];
    Skyline::Spot best;
    int best_turn = 0;
    for (int turn = 0; turn < 4; ++turn) {
      const Profile& profile = shape.turned[turn];
      // Small charts look the same from most sides.
      if (std::find(shape.turned.begin(), shape.turned.begin() + turn, profile) != shape.turned.begin() + turn)
        continue;
      const auto spot = skyline.find(profile, turn % 2 == 0 ? shape.box.y : shape.box.x, strategy);
      if (spot.cost < best.cost) best = spot, best_turn = turn;
    }
    if (best.x < 0) return std::nullopt;
    skyline.put(shape.turned[best_turn], best);
    placements[i] = {best_turn, {best.x, best.y}, shape.box};
  }
  return placements;
}

// At one density; empty where they do not fit, or when cancelled.
std::optional<Packing> pack(std::span<const Outline> outlines, double texels_per_unit, int side, int gap,
                            const Progress& progress) {
  const auto shapes = make_shapes(outlines, texels_per_unit, side, gap);
  if (!shapes) return std::nullopt;
  for (const Strategy& strategy : kStrategies) {
    auto placements = place(*shapes, side, gap, strategy, progress);
    if (placements) return Packing{texels_per_unit, std::move(*placements)};
    if (outlines.size() >= kManyCharts) break;
  }
  return std::nullopt;
}

// A density at which every chart is a single texel: there is no use in one below.
double least_density(std::span<const Outline> outlines) {
  float largest = 0;
  for (const Outline& outline : outlines) largest = std::max({largest, outline.size.x, outline.size.y});
  return largest > 0 ? 0.999 / double(largest) : 1;
}

}  // namespace

std::optional<Packing> pack_densely(std::span<const Outline> outlines, double first_guess, int side, int gap,
                                    const Progress& progress) {
  constexpr double kStep = 1.08;
  const auto texels_each = std::size_t(gap + 1) * std::size_t(gap + 1);
  if (outlines.size() * texels_each > std::size_t(side + gap) * std::size_t(side + gap)) return std::nullopt;
  double low = first_guess, high = first_guess * kStep;
  std::optional<Packing> best = pack(outlines, low, side, gap, progress);
  if (best) {
    while (auto denser = pack(outlines, high, side, gap, progress)) best = std::move(denser), low = high, high *= kStep;
  } else {
    const double least = least_density(outlines);
    while (!best) {
      if (low <= least || progress.cancelled()) return std::nullopt;
      high = low;
      low = std::max(low / kStep, least);
      best = pack(outlines, low, side, gap, progress);
    }
  }
  for (int i = 0; i < 4; ++i) {
    const double middle = (low + high) / 2;
    if (auto packing = pack(outlines, middle, side, gap, progress))
      best = std::move(packing), low = middle;
    else
      high = middle;
  }
  if (progress.cancelled()) return std::nullopt;
  return best;
}

}  // namespace strata::mesh
