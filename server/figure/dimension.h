#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "figure/sheet.h"

namespace strata::figure {

// Dimensions: the distance between two points of a drawing, with a dimension line, extension lines
// and ticks. Coordinates are millimeters from the sheet's top left, y down.

// Aligned: the distance on the drawing plane. Horizontal and vertical: its parts to the right and
// up on the paper.
enum class DimensionDirection { aligned, horizontal, vertical };

struct Dimension {
  using Line = std::pair<glm::dvec2, glm::dvec2>;
  std::vector<Line> lines;  // the extension lines, and then the dimension line
  std::vector<Line> ticks;
  std::string text;
  glm::dvec2 at{0};  // the middle of the text, on its baseline
  double angle = 0;  // of the text, in degrees counterclockwise
};
inline constexpr double kDimensionText_mm = 2.5;  // letter height

struct DimensionPoints {
  glm::dvec2 from{0}, to{0};
  DimensionDirection direction = DimensionDirection::aligned;
  std::string text{};
};
// Returns the length that a dimension measures, in millimeters on paper.
double measured_mm(const DimensionPoints& points);

// Places the dimension line of each dimension next to its points, outward from the middle of the
// drawing. Moves it to where it is in the drawing and does not overlap others, if there is such a
// place nearby. Omits dimensions that are shorter than 0.5 mm on paper.
std::vector<Dimension> place_dimensions(const std::vector<DimensionPoints>& points,
                                        const Box& drawing);

// Only the parts in the box of the drawing are visible.
Group dimension_group(const std::vector<Dimension>& dimensions, const Box& drawing);

}  // namespace strata::figure
