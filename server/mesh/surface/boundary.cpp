#include "mesh/surface/boundary.h"

#include <algorithm>
#include <limits>

#include "mesh/surface/connectivity.h"

namespace strata::mesh {

std::vector<std::array<std::uint32_t, 2>> boundary_edges(const Geometry& geometry) {
  const Connectivity connectivity = surface_connectivity(geometry);
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t triangle = 0; triangle < connectivity.n_faces(); ++triangle)
    for (const auto side : connectivity.sides_of(triangle))
      if (connectivity.is_open(side)) {
        const std::uint32_t from = connectivity.from(side), to = connectivity.to(side);
        edges.push_back({std::min(from, to), std::max(from, to)});
      }
  // Removes edges with open sides of several triangles, because the mesh does not end there.
  auto sorted = edges;
  std::ranges::sort(sorted);
  std::erase_if(
      edges, [&](const auto& edge) { return std::ranges::equal_range(sorted, edge).size() > 1; });
  return edges;
}

BoundaryDistance::BoundaryDistance(const Geometry& geometry) {
  const auto edges = boundary_edges(geometry);
  if (edges.empty()) return;
  // The triangles are sorted along a curve through space, and so are their edges. The search tree
  // needs no other order.
  auto rims = std::make_shared<Geometry>();
  rims->origin = geometry.origin;
  for (const auto& edge : edges)
    for (const std::uint32_t k : {edge[0], edge[1], edge[1]}) {
      rims->indices.push_back(static_cast<std::uint32_t>(rims->vertices.size()));
      Vertex vertex{};
      vertex.position = glm::vec3(geometry.positions[k] - geometry.origin);
      vertex.position_index = static_cast<std::uint32_t>(rims->positions.size());
      rims->vertices.push_back(vertex);
      rims->positions.push_back(geometry.positions[k]);
    }
  tree_ = std::make_unique<SearchTree>(std::move(rims));
}

float BoundaryDistance::at(const glm::vec3& position) const {
  if (!tree_) return std::numeric_limits<float>::quiet_NaN();
  const auto hit = tree_->nearest(position, std::numeric_limits<float>::max());
  return hit ? hit->distance : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace strata::mesh
