#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::test {

// The faults of a surface, counted by brute force.
struct ManifoldFaults {
  std::size_t crowded_edges = 0;     // edges of more than two triangles
  std::size_t disagreements = 0;     // two triangles that use an edge in the same direction
  std::size_t vertices_of_fans = 0;  // vertices whose triangles are not one fan
  std::size_t boundary_edges = 0;    // not a fault
};

inline ManifoldFaults manifold_faults(const mesh::TriangleMesh& mesh) {
  ManifoldFaults faults;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> edges;  // per direction
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> links(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[i + k], b = mesh.triangles[i + (k + 1) % 3],
                          c = mesh.triangles[i + (k + 2) % 3];
      ++(a < b ? edges[{a, b}].first : edges[{b, a}].second);
      links[a].push_back({b, c});
    }
  for (const auto& [ends, sides] : edges) {
    faults.crowded_edges += sides.first + sides.second > 2;
    faults.disagreements += sides.first > 1 || sides.second > 1;
    faults.boundary_edges += sides.first + sides.second == 1;
  }
  for (const auto& link : links) {
    if (link.empty()) continue;
    std::set<std::uint32_t> reached{link[0].first, link[0].second};
    for (bool grew = true; grew;) {
      grew = false;
      for (const auto& [b, c] : link)
        if (reached.contains(b) != reached.contains(c)) {
          reached.insert(b);
          reached.insert(c);
          grew = true;
        }
    }
    for (const auto& [b, c] : link)
      if (!reached.contains(b)) {
        ++faults.vertices_of_fans;
        break;
      }
  }
  return faults;
}

}  // namespace strata::test
