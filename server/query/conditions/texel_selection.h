#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace strata::mesh {
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

// A set of texels of a surface map: a word for each of its slots, bit y * 8 + x, as in
// SurfaceMap::surface_mask.
using TexelSelection = std::vector<std::uint64_t>;

struct SelectionExtent {
  std::uint64_t texels = 0;
  double area = 0;            // unit²
  glm::vec3 low{0}, high{0};  // model space; set if a texel is selected
};
// Measures the surface texels in `selection`; null: all. The same result on any number of threads.
SelectionExtent measure_selection(const mesh::SurfaceMap& map, const TexelSelection* selection,
                                  int threads = 1);

}  // namespace strata::query
