#pragma once

#include <string>

#include "figure/sheet.h"

namespace strata::figure {

// Returns a scale as text, for example "1 : 50" or "2 : 1".
std::string scale_text(double scale);

// A scale bar with a round length, at least 40 % of the widest length.
struct ScaleBar {
  double length_mm = 0;  // on paper
  int steps = 1;         // number of equal steps
  double step = 0;       // length of a step, in `unit`
  std::string unit;      // "mm", "cm", "m", "km"
};
ScaleBar scale_bar(double scale, double widest_mm);

// Returns the bar with its numbers below and the scale above. The lower edge of the numbers is at
// `left_bottom`. The last number can extend kBarOverhang_mm beyond the bar. A short bar has numbers
// only at its ends.
inline constexpr double kBarOverhang_mm = 6, kBarHeight_mm = 10;
Group bar_group(std::string id, const ScaleBar& bar, double scale, const glm::dvec2& left_bottom);

// Returns an arrow to the north, which is a direction on the paper.
Group arrow_group(std::string id, const glm::dvec2& north, const glm::dvec2& middle,
                  double length_mm);

}  // namespace strata::figure
