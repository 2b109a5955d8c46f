#pragma once

#include <utility>
#include <vector>

#include "figure/sheet.h"

namespace strata::figure {

// The hatch and the dots of an area. They cover slightly more than the area, so the area must clip
// them. Lines and dots have fixed places on the sheet: areas with the same pattern match.

struct AreaPattern {
  std::vector<std::pair<glm::dvec2, glm::dvec2>> lines;  // middle lines of a hatch
  double width_mm = 0;                                   // of the lines
  std::vector<glm::dvec2> dots;                          // middles
  double radius_mm = 0;                                  // of the dots
};

// Returns nothing for areas without hatch or dots.
AreaPattern pattern_of(const Area& area);

}  // namespace strata::figure
