#include "mesh/smooth.h"

#include <algorithm>

#include "mesh/adjacency.h"

namespace strata::mesh {

std::vector<glm::vec3> laplacian_smoothed(std::span<const std::uint32_t> triangles,
                                          std::span<const std::uint32_t> neighbours,
                                          std::span<const glm::vec3> positions, int iterations) {
  constexpr float kStep = 0.6f;
  std::vector<glm::vec3> smoothed(positions.begin(), positions.end());
  std::vector<glm::vec3> sum(positions.size());
  std::vector<float> weight(positions.size());
  std::vector<bool> on_boundary(positions.size(), false);
  const auto other = [&](std::size_t corner) { return triangles[corner % 3 == 2 ? corner - 2 : corner + 1]; };
  for (std::size_t c = 0; c < triangles.size(); ++c)
    if (neighbours[c] == kNoTriangle) on_boundary[triangles[c]] = on_boundary[other(c)] = true;
  for (int i = 0; i < iterations; ++i) {
    std::fill(sum.begin(), sum.end(), glm::vec3(0));
    std::fill(weight.begin(), weight.end(), 0.f);
    for (std::size_t c = 0; c < triangles.size(); ++c) {
      const std::uint32_t a = triangles[c], b = other(c);
      if (!on_boundary[a]) sum[a] += smoothed[b], weight[a] += 1;
      if (!on_boundary[b]) sum[b] += smoothed[a], weight[b] += 1;
    }
    for (std::size_t v = 0; v < smoothed.size(); ++v)
      if (weight[v] > 0) smoothed[v] += kStep * (sum[v] / weight[v] - smoothed[v]);
  }
  return smoothed;
}

}  // namespace strata::mesh
