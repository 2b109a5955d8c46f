#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/progress.h"
#include "mesh/atlas/charts.h"

namespace strata::mesh {

// Computes the position of each corner in the plane of its chart, 3 per triangle, in units of the
// unit mesh. Charts before number `first` are not changed. Charts are projected along their axes.
// If the projection folds or squeezes triangles, the vertices around them are moved within the
// chart. The rim of the chart does not move. Each chart is then scaled to the area of its surface.
// The result does not depend on the number of threads. When cancelled, the function ends early and
// does not update all corners.
void flatten(const ChartSurface& surface, std::span<const Chart> charts, std::size_t first,
             const Progress& progress, std::vector<glm::vec2>& plane, int threads = 2);

// Returns the triangles that are folded in the plane or keep less than 1 / `most_stretch` of their
// area there. Triangles smaller than `least_area` are not included.
std::vector<std::uint32_t> squeezed_faces(const ChartSurface& surface,
                                          std::span<const glm::vec2> plane, float most_stretch,
                                          float least_area);

// Returns the number of each triangle's chart.
std::vector<std::uint32_t> chart_of_faces(std::span<const Chart> charts,
                                          std::size_t triangle_count);

}  // namespace strata::mesh
