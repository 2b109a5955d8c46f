#include "mesh/analysis/vertex_openness.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>

#include "mesh/analysis/openness.h"
#include "mesh/parallel.h"
#include "mesh/surface/search_tree.h"
#include "mesh/surface/surface_normals.h"

namespace strata::mesh {
namespace {

constexpr std::size_t kRays = 24'000'000, kFewestRays = 16, kMostRays = 64;
// The distance within which a wall darkens its surroundings, as a share of the model's extent.
constexpr float kReach = 0.25f;
constexpr float kSuspicious = 0.1f;  // an outer side this dark may be an inner side
constexpr int kSmoothings = 2;       // reduces the noise of few rays
constexpr int kPositionsAtOnce = 2048;

// Returns a pointer that does not own the geometry. The geometry must outlive the pointer.
std::shared_ptr<const Geometry> borrowed(const Geometry& geometry) {
  return {std::shared_ptr<void>(), &geometry};
}

float openness_at(const Openness& rays, const glm::vec3& position, const glm::vec3& normal) {
  const float outside = rays.at(position, normal);
  if (std::isnan(outside)) return 1;
  return outside < kSuspicious ? std::max(outside, rays.at(position, -normal)) : outside;
}

// Replaces each value by the mean of its position and the positions connected to it by triangles.
void smooth(const Geometry& geometry, std::vector<float>& values) {
  std::vector<float> sums(values), weights(values.size(), 1);
  for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) {
    std::uint32_t corners[3];
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = geometry.vertices[geometry.indices[i + k]].position_index;
    const float sum = values[corners[0]] + values[corners[1]] + values[corners[2]];
    for (const std::uint32_t corner : corners) {
      sums[corner] += 0.5f * (sum - values[corner]);
      weights[corner] += 1;
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = sums[i] / weights[i];
}

void put(Vertex& vertex, float openness) {
  const auto byte = static_cast<std::uint32_t>(std::lround(std::clamp(openness, 0.f, 1.f) * 255));
  vertex.color = (vertex.color & 0xffffffu) | byte << 24;
}

float openness_of(const Vertex& vertex) { return static_cast<float>(vertex.color >> 24) / 255; }

}  // namespace

Result<void> bake_openness(Geometry& geometry, Progress& progress) {
  const std::size_t positions = geometry.positions.size();
  const auto rays_each =
      std::clamp(kRays / std::max<std::size_t>(positions, 1), kFewestRays, kMostRays);
  const float extent = glm::length(geometry.box_max - geometry.box_min);
  const auto shared = borrowed(geometry);
  const auto rays =
      STRATA_TRY(Openness::make(shared, kReach * extent, static_cast<int>(rays_each), progress));
  const SurfaceNormals normals(shared);
  std::vector<float> values(positions, 1);
  std::atomic<std::size_t> done{0};
  const auto chunks = static_cast<int>((positions + kPositionsAtOnce - 1) / kPositionsAtOnce);
  parallel_for(background_threads(), chunks, [&](int chunk) {
    if (progress.cancelled()) return;
    const std::size_t first = std::size_t{kPositionsAtOnce} * static_cast<std::size_t>(chunk),
                      end = std::min(first + kPositionsAtOnce, positions);
    for (std::size_t i = first; i < end; ++i)
      values[i] = openness_at(*rays, glm::vec3(geometry.positions[i] - geometry.origin),
                              normals.at_position(static_cast<std::uint32_t>(i)));
    progress.report(static_cast<double>(done += end - first) / static_cast<double>(positions),
                    "Shading the model");
  });
  if (progress.cancelled()) return cancelled_problem();
  for (int i = 0; i < kSmoothings; ++i) smooth(geometry, values);
  for (Vertex& vertex : geometry.vertices) put(vertex, values[vertex.position_index]);
  return {};
}

void copy_openness(const Geometry& from, Geometry& to) {
  const SearchTree tree(borrowed(from));
  const auto chunks =
      static_cast<int>((to.vertices.size() + kPositionsAtOnce - 1) / kPositionsAtOnce);
  parallel_for(background_threads(), chunks, [&](int chunk) {
    const std::size_t first = std::size_t{kPositionsAtOnce} * static_cast<std::size_t>(chunk),
                      end = std::min(first + kPositionsAtOnce, to.vertices.size());
    for (std::size_t i = first; i < end; ++i) {
      const auto hit =
          tree.nearest(to.vertices[i].position, std::numeric_limits<float>::infinity());
      if (!hit) continue;
      float openness = 0;
      for (int k = 0; k < 3; ++k)
        openness += hit->barycentric[k] *
                    openness_of(from.vertices[from.indices[3 * std::size_t{hit->triangle} +
                                                           static_cast<std::size_t>(k)]]);
      put(to.vertices[i], openness);
    }
  });
}

}  // namespace strata::mesh
