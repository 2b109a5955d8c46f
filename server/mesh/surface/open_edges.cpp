#include "mesh/surface/open_edges.h"

#include <algorithm>
#include <functional>

#include "mesh/surface/boundary_loops.h"

namespace strata::mesh {

OpenEdges measure_open_edges(const Geometry& geometry) {
  const Connectivity connectivity = surface_connectivity(geometry);
  OpenEdges edges;
  for (const BoundaryLoop& loop : boundary_loops(connectivity)) {
    double length = 0;
    for (const auto side : loop)
      length += glm::distance(geometry.positions[connectivity.from(side)],
                              geometry.positions[connectivity.to(side)]);
    ++edges.loops;
    edges.length += length;
    edges.longest.push_back(length);
  }
  std::ranges::sort(edges.longest, std::greater());
  edges.longest.resize(std::min(edges.longest.size(), OpenEdges::kMaxListed));
  return edges;
}

}  // namespace strata::mesh
