#include "mesh/surface/uv_islands.h"

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

CornerWelder::Number CornerWelder::number(std::uint32_t position, glm::vec2 uv) {
  std::uint32_t& head = first_[position];
  for (std::uint32_t v = head; v != kEnd; v = vertices_[v].next) {
    if (vertices_[v].uv == uv) return {v, false};
  }
  const auto added = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back({uv, head});
  head = added;
  return {added, true};
}

std::size_t weld_corners(std::span<const std::uint32_t> position_of_corner,
                         std::span<const glm::vec2> uv_of_corner, std::size_t position_count,
                         std::vector<std::uint32_t>& indices) {
  CornerWelder welder(position_count);
  indices.resize(position_of_corner.size());
  for (std::size_t c = 0; c < indices.size(); ++c) {
    indices[c] = welder.number(position_of_corner[c], uv_of_corner[c]).index;
  }
  return welder.count();
}

}  // namespace strata::mesh
