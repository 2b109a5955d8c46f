#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/atlas/charts.h"

namespace strata::mesh {

// Cuts charts that leave most of their boxes empty, for example frames, rings and branches. The
// cuts run across the longer sides of the boxes and along edges of triangles. Cutting ends when the
// parts fill their boxes or their boxes have an area in the plane below `least_box`. `plane` is the
// result of `flatten` and is not changed. Returns true if any chart was cut.
bool cut_hollow_charts(const ChartSurface& surface, std::span<const glm::vec2> plane,
                       float least_box, std::vector<Chart>& charts);

}  // namespace strata::mesh
