#include "mesh/uv_islands.h"

#include <numeric>

namespace strata::mesh {

UvIslands find_islands(std::span<const std::uint32_t> indices, std::size_t vertex_count) {
  constexpr std::uint32_t kUnnumbered = 0xffffffffu;
  std::vector<std::uint32_t> parent(vertex_count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const auto a = root(indices[i]), b = root(indices[i + 1]);
    if (a != b) parent[std::max(a, b)] = std::min(a, b);
    const auto c = root(indices[i + 2]), d = root(indices[i]);
    if (c != d) parent[std::max(c, d)] = std::min(c, d);
  }
  UvIslands islands;
  islands.of_triangle.resize(indices.size() / 3);
  std::vector<std::uint32_t> number(vertex_count, kUnnumbered);
  for (std::size_t t = 0; t < islands.of_triangle.size(); ++t) {
    auto& id = number[root(indices[3 * t])];
    if (id == kUnnumbered) id = islands.count++;
    islands.of_triangle[t] = id;
  }
  return islands;
}

std::size_t weld_corners(std::span<const std::uint32_t> position_of_corner, std::span<const glm::vec2> uv_of_corner,
                         std::size_t position_count, std::vector<std::uint32_t>& indices) {
  constexpr std::uint32_t kEnd = 0xffffffffu;
  struct Vertex {
    glm::vec2 uv;
    std::uint32_t next;  // of the same position
  };
  std::vector<std::uint32_t> first(position_count, kEnd);
  std::vector<Vertex> vertices;
  indices.resize(position_of_corner.size());
  for (std::size_t c = 0; c < position_of_corner.size(); ++c) {
    auto& head = first[position_of_corner[c]];
    std::uint32_t v = head;
    while (v != kEnd && vertices[v].uv != uv_of_corner[c]) v = vertices[v].next;
    if (v == kEnd) {
      v = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back({uv_of_corner[c], head});
      head = v;
    }
    indices[c] = v;
  }
  return vertices.size();
}

}  // namespace strata::mesh
