#pragma once

#include <cstdint>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The rims of a chart of a model's atlas: closed rings of vertices, each once, in the direction of
// the triangles. They enclose the chart.
struct ChartRims {
  std::vector<std::vector<std::uint32_t>> rings;
};

// The rims of every chart, in the order of their first triangles. See Connectivity for the memory.
std::vector<ChartRims> find_chart_rims(const Geometry& geometry);

}  // namespace strata::mesh
