#pragma once

#include <optional>
#include <vector>

#include "figure/sheet.h"

namespace strata::figure {

// The views of a sheet in a grid. Coordinates are millimeters on paper.

struct ViewSize {
  glm::dvec2 life_mm{0};          // of the content at 1 : 1
  glm::dvec2 border_mm{0};        // on each side, which stays empty
  std::optional<double> scale{};  // of this view only
};

// The space between views, and below each view for its caption.
struct ViewSpacing {
  double gap_mm = 0, below_mm = 0;
};

struct ViewGrid {
  double scale = 1;        // of the views without their own scale
  double tightness = 0;    // the share of the area that the views need; above 1 they do not fit
  std::vector<Box> boxes;  // of the views, from left to right and from top to bottom
};

// Chooses the number of columns with the largest common scale. Columns are as wide, and rows as
// high, as their content needs. The rest of the area is distributed in proportion. Without `scale`,
// the common scale is the first one of round_scales() at which all views fit. Views that do not fit
// get smaller boxes. A view whose own scale is too large gets an equal share of the area, so that
// the others fit.
ViewGrid arrange_views(const std::vector<ViewSize>& views, const Box& area,
                       const ViewSpacing& spacing, std::optional<double> scale);

}  // namespace strata::figure
