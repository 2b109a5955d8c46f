#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// The reasons why the texture coordinates of a triangle cannot be used for layers.
enum class UvFault : std::uint8_t { none, not_finite, outside, no_area, overlap };
constexpr int kUvFaults = 5;
std::string_view words_of(UvFault fault);  // "lie outside the unit square"

struct UvFaults {
  std::vector<UvFault> of_triangle;
  std::vector<std::uint64_t> count = std::vector<std::uint64_t>(kUvFaults);
  double area = 0;  // surface area of the triangles with a fault, in unit²

  void set(std::size_t triangle, UvFault fault, double surface_area);
};

// Finds the faults of each single triangle. `corner_uvs` are the coordinates of the mesh. Triangles
// without area have no fault.
UvFaults find_single_faults(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs);

// Marks triangles that share texels with others at `resolution`, until the remaining triangles
// share no texels. Triangles with the most shared texels are marked first, so a triangle that
// covers many others is found. With the same number of shared texels, later triangles are marked
// first. All coordinates of triangles without a fault must be in [0,1]².
void find_overlaps(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs, int resolution,
                   UvFaults& faults);

}  // namespace strata::mesh
