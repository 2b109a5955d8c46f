#pragma once

#include <cstdint>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The rims of a chart in a model's atlas. They enclose the chart. A rim is a closed ring of
// vertices in the direction of the triangles, and each vertex occurs once.
struct ChartRims {
  std::vector<std::vector<std::uint32_t>> rings;
};

// Returns the rims of every chart, in the order of their first triangles. See Connectivity for the
// memory.
std::vector<ChartRims> find_chart_rims(const Geometry& geometry);

}  // namespace strata::mesh
