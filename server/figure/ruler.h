#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "figure/sheet.h"
#include "mesh/rollout/rollout_sheet.h"

namespace strata::figure {

// A rollout on paper.
struct UnrolledDrawing {
  mesh::RolloutSheet sheet;
  glm::dvec2 center{0};     // the point of the sheet in the middle of `area`
  double units_per_mm = 1;  // length on the sheet, in model units, of a millimeter on paper
  double mm_per_unit = 1;   // length on the object
  double zero_slant = 0;    // the slant at which the ruler shows 0
  Box area;                 // the part of the paper that shows the surface

  glm::dvec2 on_paper(const mesh::RolloutSheet::SurfacePlace& place) const;
};

// The distances between the labels and between the ticks of a ruler. A label step is a multiple of
// a tick step.
struct RulerSteps {
  double label = 0, tick = 0;
};
// Returns the steps in degrees. `mm` is the length of a degree on paper.
RulerSteps angle_steps(double mm);
// Returns the steps in millimeters of the object. `mm` is the length of one of them on paper.
RulerSteps length_steps(double mm);

// The space that the ruler needs on each side of the surface.
inline constexpr glm::dvec2 kRulerRoom_mm{14, 7};

// Returns the outline of the surface and its two rulers: degrees around the axis (from 0 to 360,
// counterclockwise when seen against the axis), and lengths along the axis or, for a cone, along
// the slant. Each edge has ticks. The longer of the edges around the axis and the left of the other
// edges have labels. A cylinder that exceeds the area has its rulers at the borders of the area. Of
// a larger cone, only the ticks inside the area are drawn.
std::vector<Group> ruler_groups(const UnrolledDrawing& drawing);

}  // namespace strata::figure
