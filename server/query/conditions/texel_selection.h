#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace strata::mesh {
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

// A set of texels of a surface map, with one 64-bit word for each slot of the map. Bit y * 8 + x is
// the texel (x, y) of the slot, as in SurfaceMap::surface_mask.
using TexelSelection = std::vector<std::uint64_t>;

struct SelectionExtent {
  std::uint64_t texels = 0;
  double area = 0;            // model units²
  glm::vec3 low{0}, high{0};  // model space; set only if a texel is selected
};
// Measures the surface texels in `selection`; null means all texels. The result does not depend on
// the number of threads.
SelectionExtent measure_selection(const mesh::SurfaceMap& map, const TexelSelection* selection,
                                  int threads = 1);

}  // namespace strata::query
