#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/progress.h"
#include "mesh/atlas/charts.h"

namespace strata::mesh {

// Sets where each corner lies in the plane of its chart, 3 a triangle, in units of the unit mesh,
// for the charts from number `first` on. Charts are projected along their axes; where that folds or
// squeezes triangles, the vertices around them are moved within the chart (its rim does not move).
// Each chart is then scaled so that its area is that of its surface. The result does not depend on
// the number of threads. When cancelled it ends early and does not update all corners.
void flatten(const ChartSurface& surface, std::span<const Chart> charts, std::size_t first,
             const Progress& progress, std::vector<glm::vec2>& plane, int threads = 2);

// Triangles that are folded in the plane or have less than 1 / `most_stretch` of their area there,
// and are no smaller than `least_area`.
std::vector<std::uint32_t> squeezed_faces(const ChartSurface& surface,
                                          std::span<const glm::vec2> plane, float most_stretch,
                                          float least_area);

// The number of the chart of each triangle.
std::vector<std::uint32_t> chart_of_faces(std::span<const Chart> charts,
                                          std::size_t triangle_count);

}  // namespace strata::mesh
