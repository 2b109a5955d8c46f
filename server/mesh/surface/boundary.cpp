#include "mesh/surface/boundary.h"

#include <algorithm>
#include <limits>

namespace strata::mesh {

std::vector<std::array<std::uint32_t, 2>> boundary_edges(const Geometry& geometry) {
  struct HalfEdge {
    std::uint32_t low, high;
    std::size_t corner;
  };
  const auto position_at = [&](std::size_t corner) {
    return geometry.vertices[geometry.indices[corner]].position_index;
  };
  std::vector<HalfEdge> half_edges(geometry.indices.size());
  for (std::size_t c = 0; c < half_edges.size(); ++c) {
    const auto a = position_at(c), b = position_at(c % 3 == 2 ? c - 2 : c + 1);
    half_edges[c] = {std::min(a, b), std::max(a, b), c};
  }
  std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.low != b.low     ? a.low < b.low
           : a.high != b.high ? a.high < b.high
                              : a.corner < b.corner;
  });
  std::vector<HalfEdge> single;
  for (std::size_t i = 0; i < half_edges.size();) {
    std::size_t j = i + 1;
    while (j < half_edges.size() && half_edges[j].low == half_edges[i].low &&
           half_edges[j].high == half_edges[i].high)
      ++j;
    if (j - i == 1 && half_edges[i].low != half_edges[i].high) single.push_back(half_edges[i]);
    i = j;
  }
  std::sort(single.begin(), single.end(),
            [](const HalfEdge& a, const HalfEdge& b) { return a.corner < b.corner; });
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(single.size());
  for (const HalfEdge& edge : single) edges.push_back({edge.low, edge.high});
  return edges;
}

BoundaryDistance::BoundaryDistance(const Geometry& geometry) {
  const auto edges = boundary_edges(geometry);
  if (edges.empty()) return;
  // The triangles' order runs along a curve through space, and so do their edges: the search tree
  // needs no other.
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
