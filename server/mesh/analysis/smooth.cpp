#include "mesh/analysis/smooth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strata::mesh {

std::vector<glm::vec3> laplacian_smoothed(std::span<const std::uint32_t> triangles,
                                          const Connectivity& connectivity,
                                          std::span<const glm::vec3> positions, int iterations,
                                          std::span<const std::uint8_t> stays) {
  constexpr float kStep = 0.6f, kMaxMove = 0.25f;
  std::vector<glm::vec3> smoothed(positions.begin(), positions.end());
  std::vector<glm::vec3> sum(positions.size());
  std::vector<float> weight(positions.size());
  std::vector<bool> is_fixed(positions.size(), false);
  for (std::size_t v = 0; v < stays.size(); ++v)
    if (stays[v]) is_fixed[v] = true;
  // A vertex moves by at most a share of the length of its shortest edge. Otherwise the long edges
  // of slivers would pull it past its neighbors.
  std::vector<float> shortest(positions.size(), std::numeric_limits<float>::max());
  for (const auto edge : connectivity.edges()) {
    const auto side = connectivity.halfedge_handle(edge, 0);
    const std::uint32_t a = connectivity.from(side), b = connectivity.to(side);
    if (connectivity.is_boundary(edge)) is_fixed[a] = is_fixed[b] = true;
    const glm::vec3 along = positions[b] - positions[a];
    const float squared = glm::dot(along, along);
    shortest[a] = std::min(shortest[a], squared), shortest[b] = std::min(shortest[b], squared);
  }
  for (float& length : shortest) length = kMaxMove * std::sqrt(length);
  for (int i = 0; i < iterations; ++i) {
    std::fill(sum.begin(), sum.end(), glm::vec3(0));
    std::fill(weight.begin(), weight.end(), 0.f);
    // Every edge is added once for each of its triangles, in the order of the triangles. Sums of
    // floats depend on their order, and the atlas depends on these sums.
    for (std::size_t c = 0; c < triangles.size(); ++c) {
      const std::uint32_t a = triangles[c], b = triangles[c % 3 == 2 ? c - 2 : c + 1];
      if (!is_fixed[a]) sum[a] += smoothed[b], weight[a] += 1;
      if (!is_fixed[b]) sum[b] += smoothed[a], weight[b] += 1;
    }
    for (std::size_t v = 0; v < smoothed.size(); ++v)
      if (weight[v] > 0) {
        const glm::vec3 move = kStep * (sum[v] / weight[v] - smoothed[v]);
        const float length = glm::length(move);
        smoothed[v] += length > shortest[v] ? move * (shortest[v] / length) : move;
      }
  }
  return smoothed;
}

}  // namespace strata::mesh
