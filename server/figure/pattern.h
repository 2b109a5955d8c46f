#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "figure/paper.h"

namespace strata::figure {

// The patterns of shaders/shared/shade.h, in millimeters on paper. A pixel of the camera's window
// is a hundredth of an inch there.
inline constexpr double kPatternPixel = kInch_mm / 100;
inline constexpr double kSpacing = 7 * kPatternPixel, kClosest = 6 * kPatternPixel;
inline constexpr double kHatchShare = 0.4, kDotShare = 0.32;  // of the spacing
inline constexpr double kGround = 0.3;                        // opacity between lines or dots
inline constexpr double kBorder = 2 * kPatternPixel;
// The width of a line in the color of an opaque area around it. Without it, programs that smooth
// the borders of areas show a light line between neighbors.
inline constexpr double kTrap_mm = 0.05;

// Returns the distance of lines or dots. `wanted` is that of the palette in millimeters on paper,
// and 0 without one. If it is too small, only every 2nd, 4th … line is drawn.
inline double pattern_spacing(double wanted) {
  const double spacing = wanted > 0 ? wanted : kSpacing;
  return spacing * std::exp2(std::max(0.0, std::ceil(std::log2(kClosest / spacing))));
}

// Returns the direction of an angle in degrees. 0 points to the right, 90 points up on the paper.
inline glm::dvec2 direction(double degrees) {
  const double angle = glm::radians(degrees);
  return {std::cos(angle), -std::sin(angle)};
}

}  // namespace strata::figure
