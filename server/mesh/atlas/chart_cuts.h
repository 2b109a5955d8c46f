#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/atlas/charts.h"

namespace strata::mesh {

// Cuts charts that leave most of their boxes empty (frames, rings, branches), across the longer
// sides of the boxes and along edges of triangles, until their parts fill their boxes or have boxes
// smaller than `least_box` (area in the plane). `plane` is the result of `flatten`; it is not
// changed. Returns whether any chart was cut.
bool cut_hollow_charts(const ChartSurface& surface, std::span<const glm::vec2> plane,
                       float least_box, std::vector<Chart>& charts);

}  // namespace strata::mesh
