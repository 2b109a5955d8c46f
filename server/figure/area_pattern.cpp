#include "figure/area_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "figure/pattern.h"

namespace strata::figure {
namespace {

using Range = std::pair<double, double>;

// Finds where an area meets straight bands, one for each line of a pattern. Line i is at
// (i + 1/2) spacings.
class Bands {
 public:
  Bands(double spacing, double reach) : spacing_(spacing), reach_(reach) {}

  // Adds a side of a ring. x is along the lines.
  void add(const glm::dvec2& from, const glm::dvec2& to) {
    const auto [low, high] = std::minmax(from.y, to.y);
    for (double line = first_at(low - reach_); at(line) <= high + reach_; ++line) {
      const double y = at(line);
      const auto x_at = [&](double height) {
        const double t = to.y == from.y ? 0 : (height - from.y) / (to.y - from.y);
        return std::lerp(from.x, to.x, t);
      };
      // The part of the side in the band.
      double begin = from.x, end = to.x;
      if (to.y != from.y) {
        begin = x_at(std::clamp(y - reach_, low, high));
        end = x_at(std::clamp(y + reach_, low, high));
      }
      Line& found = lines_[static_cast<std::int64_t>(line)];
      found.sides.push_back(std::minmax(begin, end));
      if ((from.y <= y) != (to.y <= y)) found.crossings.push_back(x_at(y));
    }
  }

  // Calls visit(y, ranges) for each line that meets the area. The ranges are in ascending order
  // and longer than the area by `longer` at both ends.
  template <class Visit>
  void for_each(double longer, const Visit& visit) {
    for (auto& [number, line] : lines_) {
      std::ranges::sort(line.crossings);
      for (std::size_t i = 0; i + 1 < line.crossings.size(); i += 2)
        line.sides.emplace_back(line.crossings[i], line.crossings[i + 1]);
      std::ranges::sort(line.sides);
      std::vector<Range> joined;
      for (const auto& [begin, end] : line.sides) {
        if (!joined.empty() && begin - longer <= joined.back().second)
          joined.back().second = std::max(joined.back().second, end + longer);
        else
          joined.emplace_back(begin - longer, end + longer);
      }
      visit(at(static_cast<double>(number)), joined);
    }
  }

 private:
  struct Line {
    std::vector<Range> sides;       // where the sides of the rings are in the band
    std::vector<double> crossings;  // where they cross the middle of the band
  };
  double at(double line) const { return (line + 0.5) * spacing_; }
  double first_at(double y) const { return std::ceil(y / spacing_ - 0.5); }

  const double spacing_, reach_;
  std::map<std::int64_t, Line> lines_;
};

}  // namespace

AreaPattern pattern_of(const Area& area) {
  AreaPattern pattern;
  if (area.pattern != Pattern::hatch && area.pattern != Pattern::dots) return pattern;
  const bool is_hatch = area.pattern == Pattern::hatch;
  const double spacing = area.spacing_mm;
  if (is_hatch)
    pattern.width_mm = kHatchShare * spacing;
  else
    pattern.radius_mm = kDotShare * spacing;
  const double reach = is_hatch ? pattern.width_mm / 2 : pattern.radius_mm;
  const glm::dvec2 along = direction(area.angle), across(-along.y, along.x);
  Bands bands(spacing, reach);
  for (const auto& ring : area.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const glm::dvec2 &from = ring[i], &to = ring[(i + 1) % ring.size()];
      bands.add({glm::dot(from, along), glm::dot(from, across)},
                {glm::dot(to, along), glm::dot(to, across)});
    }
  bands.for_each(reach, [&](double y, const std::vector<Range>& ranges) {
    for (const auto& [begin, end] : ranges) {
      if (is_hatch) {
        pattern.lines.emplace_back(begin * along + y * across, end * along + y * across);
        continue;
      }
      for (double dot = std::ceil(begin / spacing - 0.5); (dot + 0.5) * spacing <= end; ++dot)
        pattern.dots.push_back((dot + 0.5) * spacing * along + y * across);
    }
  });
  return pattern;
}

}  // namespace strata::figure
