#include "figure/dimension.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "figure/text.h"

namespace strata::figure {
namespace {

constexpr double kShortest_mm = 0.5;
constexpr double kOffset_mm = 8, kStep_mm = 6;  // of the first and of further dimension lines
constexpr int kMaxSteps = 4;
// The extension lines begin at this distance from the points, and extend beyond the dimension line.
constexpr double kGap_mm = 1, kBeyond_mm = 1.5;
constexpr double kTick_mm = 2.4;  // length
constexpr double kThin_mm = 0.18, kTickWidth_mm = 0.4;
constexpr double kTextGap_mm = 0.8;  // between the dimension line and the text
// At most this many places of a line, which is more than on the diagonal of the largest sheet.
constexpr double kMostPlaces = 400;
constexpr double kClearance_mm = 3.6;  // between dimension lines

// The directions of a dimension line, and from its points to it.
struct Axes {
  glm::dvec2 along, across;
};

Axes axes_of(const DimensionPoints& points) {
  switch (points.direction) {
    case DimensionDirection::horizontal: return {{1, 0}, {0, -1}};
    case DimensionDirection::vertical: return {{0, 1}, {1, 0}};
    case DimensionDirection::aligned: break;
  }
  const glm::dvec2 along = glm::normalize(points.to - points.from);
  return {along, {along.y, -along.x}};
}

// Returns the dimension whose line is at a coordinate across.
Dimension dimension_at(const DimensionPoints& points, const Axes& axes, double across) {
  const auto foot = [&](const glm::dvec2& point) {
    return point + (across - glm::dot(point, axes.across)) * axes.across;
  };
  const glm::dvec2 begin = foot(points.from), end = foot(points.to);
  Dimension dimension;
  for (const auto& [point, on_line] : {std::pair(points.from, begin), std::pair(points.to, end)}) {
    const double length = glm::distance(point, on_line);
    if (length <= kGap_mm) continue;
    const glm::dvec2 outward = (on_line - point) / length;
    dimension.lines.emplace_back(point + kGap_mm * outward, on_line + kBeyond_mm * outward);
  }
  dimension.lines.emplace_back(begin, end);
  // The text can be read from below or from the right.
  glm::dvec2 reading = begin.x < end.x ? end - begin : begin - end;
  if (std::abs(reading.x) < 1e-6 * std::abs(reading.y)) reading = {0, -glm::length(reading)};
  reading = glm::normalize(reading);
  const glm::dvec2 up(reading.y, -reading.x);
  // Ticks rise to the right of the text.
  const glm::dvec2 tick = (reading + up) * (kTick_mm / 2 / std::numbers::sqrt2);
  for (const glm::dvec2& at : {begin, end}) dimension.ticks.emplace_back(at - tick, at + tick);
  dimension.text = points.text;
  dimension.at = (begin + end) / 2.0 + kTextGap_mm * up;
  dimension.angle = std::atan2(-reading.y, reading.x) * 180 / std::numbers::pi;
  return dimension;
}

// Returns points on the middle of the text and along the dimension line. They are as far apart as
// the letters are high. The ends are left out, because dimensions of a chain have common ends.
std::vector<glm::dvec2> places_of(const Dimension& dimension) {
  const auto& [begin, end] = dimension.lines.back();
  const double turn = dimension.angle * std::numbers::pi / 180;
  const glm::dvec2 reading(std::cos(turn), -std::sin(turn)), up(reading.y, -reading.x);
  std::vector<glm::dvec2> places;
  const auto add = [&](const glm::dvec2& from, const glm::dvec2& to) {
    const double needed = std::ceil(glm::distance(from, to) / kDimensionText_mm);
    const int steps = static_cast<int>(std::clamp(needed, 1.0, kMostPlaces));
    for (int i = 0; i <= steps; ++i) places.push_back(glm::mix(from, to, 1.0 * i / steps));
  };
  const double length = glm::distance(begin, end);
  if (length > 2 * kClearance_mm) {
    const glm::dvec2 inset = (end - begin) * (kClearance_mm / 1.9 / length);
    add(begin + inset, end - inset);
  }
  const glm::dvec2 half = reading * (width_mm(dimension.text, kDimensionText_mm, false) / 2),
                   middle = dimension.at + up * (kDimensionText_mm / 2);
  add(middle - half, middle + half);
  return places;
}

bool is_inside(const std::vector<glm::dvec2>& places, const Box& box) {
  const glm::dvec2 low = box.corner + kDimensionText_mm,
                   high = box.corner + box.size - kDimensionText_mm;
  return std::ranges::all_of(places, [&](const glm::dvec2& place) {
    return place.x >= low.x && place.y >= low.y && place.x <= high.x && place.y <= high.y;
  });
}

bool overlap(const std::vector<glm::dvec2>& places, const std::vector<glm::dvec2>& taken) {
  return std::ranges::any_of(places, [&](const glm::dvec2& place) {
    return std::ranges::any_of(taken, [&](const glm::dvec2& other) {
      return glm::distance(place, other) < kClearance_mm;
    });
  });
}

// Returns the numbers of the dimensions that are drawn. The lines of short dimensions are nearer to
// their points, so that the extension lines of long ones do not cross them.
std::vector<std::size_t> shortest_first(const std::vector<DimensionPoints>& points) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (measured_mm(points[i]) >= kShortest_mm) numbers.push_back(i);
  std::ranges::stable_sort(numbers, {}, [&](std::size_t i) { return measured_mm(points[i]); });
  return numbers;
}

}  // namespace

double measured_mm(const DimensionPoints& points) {
  const glm::dvec2 apart = glm::abs(points.to - points.from);
  switch (points.direction) {
    case DimensionDirection::horizontal: return apart.x;
    case DimensionDirection::vertical: return apart.y;
    case DimensionDirection::aligned: break;
  }
  return glm::length(apart);
}

std::vector<Dimension> place_dimensions(const std::vector<DimensionPoints>& points,
                                        const Box& drawing) {
  std::map<std::size_t, Dimension> placed;  // by number
  std::vector<glm::dvec2> taken;
  const glm::dvec2 middle = drawing.corner + drawing.size / 2.0;
  for (const std::size_t number : shortest_first(points)) {
    const DimensionPoints& each = points[number];
    const Axes axes = axes_of(each);
    const double from = glm::dot(each.from, axes.across), to = glm::dot(each.to, axes.across);
    const bool is_low = (from + to) / 2 < glm::dot(middle, axes.across);
    std::optional<Dimension> best;  // the first one inside the drawing, or the first one at all
    bool is_best_inside = false, is_free = false;
    for (const bool is_outward : {true, false})
      for (int step = 0; step < kMaxSteps && !is_free; ++step) {
        const double offset = kOffset_mm + step * kStep_mm;
        const bool downward = is_low == is_outward;
        Dimension dimension = dimension_at(
            each, axes, downward ? std::min(from, to) - offset : std::max(from, to) + offset);
        const auto places = places_of(dimension);
        const bool inside = is_inside(places, drawing);
        is_free = inside && !overlap(places, taken);
        if (best && !is_free && (is_best_inside || !inside)) continue;
        best = std::move(dimension);
        is_best_inside = inside;
      }
    const auto places = places_of(*best);
    taken.insert(taken.end(), places.begin(), places.end());
    placed[number] = std::move(*best);
  }
  std::vector<Dimension> dimensions;
  for (auto& [number, dimension] : placed) dimensions.push_back(std::move(dimension));
  return dimensions;
}

Group dimension_group(const std::vector<Dimension>& dimensions, const Box& drawing) {
  Group group{"dimensions", {}};
  group.clip = drawing;
  for (const Dimension& dimension : dimensions) {
    for (const auto& [from, to] : dimension.lines)
      group.items.push_back(Path{{from, to}, false, {}, kThin_mm});
    for (const auto& [from, to] : dimension.ticks)
      group.items.push_back(Path{{from, to}, false, {}, kTickWidth_mm});
    group.items.push_back(Words{dimension.at, dimension.text, kDimensionText_mm, false,
                                Anchor::middle, true, dimension.angle});
  }
  return group;
}

}  // namespace strata::figure
