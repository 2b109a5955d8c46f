#include "figure/area_pattern.h"

#include <algorithm>
#include <limits>

#include "figure/pattern.h"

namespace strata::figure {

AreaPattern pattern_of(const Area& area) {
  AreaPattern pattern;
  if (area.rings.empty() || (area.pattern != Pattern::hatch && area.pattern != Pattern::dots))
    return pattern;
  const double spacing = area.spacing_mm;
  const glm::dvec2 along = direction(area.angle), across(-along.y, along.x);
  // The box around the area, along the lines and across.
  glm::dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const auto& ring : area.rings)
    for (const glm::dvec2& point : ring) {
      const glm::dvec2 turned(glm::dot(point, along), glm::dot(point, across));
      low = glm::min(low, turned);
      high = glm::max(high, turned);
    }
  const auto at = [&](double x, double y) { return x * along + y * across; };
  const auto first = [&](double from) { return (std::floor(from / spacing - 1) + 0.5) * spacing; };
  for (double y = first(low.y); y < high.y + spacing; y += spacing) {
    if (area.pattern == Pattern::hatch) {
      pattern.lines.emplace_back(at(low.x - spacing, y), at(high.x + spacing, y));
      continue;
    }
    for (double x = first(low.x); x < high.x + spacing; x += spacing)
      pattern.dots.push_back(at(x, y));
  }
  pattern.width_mm = area.pattern == Pattern::hatch ? kHatchShare * spacing : 0;
  pattern.radius_mm = area.pattern == Pattern::dots ? kDotShare * spacing : 0;
  return pattern;
}

}  // namespace strata::figure
