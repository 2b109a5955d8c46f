#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace strata::mesh {

// The pieces of a parametrization. Triangles are in the same island if they are connected by a
// chain of corners with the same position and UV.
struct UvIslands {
  std::vector<std::uint32_t> of_triangle;  // numbered from 0 in the order of their first triangle
  std::uint32_t count = 0;
};

// Numbers corners from 0 by first use. Two corners have the same number only if they have the same
// position and UV.
class CornerWelder {
 public:
  explicit CornerWelder(std::size_t position_count) : first_(position_count, kEnd) {}

  struct Number {
    std::uint32_t index;
    bool is_new;
  };
  Number number(std::uint32_t position, glm::vec2 uv);
  std::size_t count() const { return vertices_.size(); }

 private:
  static constexpr std::uint32_t kEnd = 0xffffffffu;
  struct Vertex {
    glm::vec2 uv;
    std::uint32_t next;  // with the same position
  };
  std::vector<std::uint32_t> first_;  // for each position: head of the list of its vertices
  std::vector<Vertex> vertices_;
};

// `indices` has 3 entries per triangle. Entries are equal if and only if position and UV are equal.
UvIslands find_islands(std::span<const std::uint32_t> indices, std::size_t vertex_count);

// Computes such indices with a CornerWelder. Returns the number of distinct indices.
std::size_t weld_corners(std::span<const std::uint32_t> position_of_corner,
                         std::span<const glm::vec2> uv_of_corner, std::size_t position_count,
                         std::vector<std::uint32_t>& indices);

}  // namespace strata::mesh
