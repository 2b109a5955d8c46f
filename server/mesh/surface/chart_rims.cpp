#include "mesh/surface/chart_rims.h"

#include <unordered_map>

#include "mesh/surface/boundary_loops.h"
#include "mesh/surface/uv_islands.h"

namespace strata::mesh {
namespace {

// A loop that returns to a vertex encloses a hole that touches the rim there. The hole becomes a
// separate ring.
void add_rings(const Connectivity& connectivity, const BoundaryLoop& loop, ChartRims& rims) {
  std::vector<std::uint32_t> path;
  std::unordered_map<std::uint32_t, std::size_t> place_in_path;
  for (const auto side : loop) {
    const std::uint32_t vertex = connectivity.from(side);
    const auto [known, is_new] = place_in_path.try_emplace(vertex, path.size());
    if (!is_new) {
      const auto begin = path.begin() + static_cast<std::ptrdiff_t>(known->second);
      rims.rings.emplace_back(begin, path.end());
      for (auto passed = begin + 1; passed != path.end(); ++passed) place_in_path.erase(*passed);
      path.erase(begin, path.end());
    }
    path.push_back(vertex);
  }
  rims.rings.push_back(std::move(path));
}

}  // namespace

std::vector<ChartRims> find_chart_rims(const Geometry& geometry) {
  const UvIslands charts = find_islands(geometry.indices, geometry.vertices.size());
  const Connectivity connectivity(geometry.indices, geometry.vertices.size());
  std::unordered_map<std::uint32_t, std::size_t> number_of;
  std::vector<ChartRims> all;
  for (const BoundaryLoop& loop : boundary_loops(connectivity)) {
    const auto triangle = connectivity.face_handle(loop.front()).idx();
    const std::uint32_t chart = charts.of_triangle[static_cast<std::size_t>(triangle)];
    const auto [known, is_new] = number_of.try_emplace(chart, all.size());
    if (is_new) all.emplace_back();
    add_rings(connectivity, loop, all[known->second]);
  }
  return all;
}

}  // namespace strata::mesh
