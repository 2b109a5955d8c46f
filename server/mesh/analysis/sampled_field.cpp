#include "mesh/analysis/sampled_field.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace strata::mesh {
namespace {

constexpr double kMaxGridPoints = 4e6;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr const char* kMeasuring = "Measuring the shape";

glm::vec3 corner(const Geometry& geometry, std::size_t triangle, std::size_t k) {
  return geometry.vertices[geometry.indices[3 * triangle + k]].position;
}

float longest_edge(const Geometry& geometry, std::size_t triangle) {
  const glm::vec3 a = corner(geometry, triangle, 0), b = corner(geometry, triangle, 1),
                  c = corner(geometry, triangle, 2);
  return std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
}

int cuts_of(float edge, float spacing) { return static_cast<int>(std::ceil(edge / spacing)); }
int points_of(int cuts) { return (cuts + 1) * (cuts + 2) / 2; }

// Widens the spacing until the total number of points is small enough. Long triangles are cut
// evenly, so slivers get more points than their area needs.
float fitting_spacing(const std::vector<float>& edges, float spacing) {
  for (;; spacing *= 1.5f) {
    double points = 0;
    for (const float edge : edges)
      if (edge > spacing) points += points_of(std::min(cuts_of(edge, spacing), 100'000'000));
    if (points <= kMaxGridPoints) return spacing;
  }
}

float mean_of_defined(const std::array<float, 3>& values, const glm::vec3& weights) {
  float sum = 0, weight = 0, fallback = kNone;
  for (int k = 0; k < 3; ++k) {
    if (std::isnan(values[k])) continue;
    sum += weights[k] * values[k];
    weight += weights[k];
    fallback = values[k];
  }
  return weight > 1e-6f ? sum / weight : fallback;
}

}  // namespace

Result<SampledField> SampledField::make(std::shared_ptr<const Geometry> source,
                                        const SurfaceNormals& normals, float spacing,
                                        const PointFunction& function, Progress& progress,
                                        int threads) {
  SampledField field;
  field.geometry_ = std::move(source);
  const Geometry& geometry = *field.geometry_;
  std::vector<float> edges(geometry.triangle_count());
  for (std::size_t t = 0; t < edges.size(); ++t) edges[t] = longest_edge(geometry, t);
  spacing = fitting_spacing(edges, spacing);

  // Only the vertices of small triangles are evaluated.
  std::vector<glm::vec3> position_of(geometry.positions.size());
  std::vector<std::uint8_t> is_used(geometry.positions.size(), 0);
  std::vector<std::uint32_t> gridded;
  for (std::uint32_t t = 0; t < edges.size(); ++t) {
    if (edges[t] > spacing) {
      const int cuts = cuts_of(edges[t], spacing);
      field.grids_[t] = {static_cast<std::uint32_t>(field.grid_values_.size()), cuts};
      field.grid_values_.resize(field.grid_values_.size() + points_of(cuts), kNone);
      gridded.push_back(t);
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Vertex& vertex = geometry.vertices[geometry.indices[3 * std::size_t{t} + k]];
      position_of[vertex.position_index] = vertex.position;
      is_used[vertex.position_index] = 1;
    }
  }
  field.vertex_values_.assign(geometry.positions.size(), kNone);

  constexpr std::size_t kAtOnce = 1024;
  const std::size_t vertices = position_of.size(), total = vertices + field.grid_values_.size();
  std::atomic<std::size_t> done{0};
  const auto report = [&](std::size_t more) {
    const std::size_t now = done += more;
    progress.report(static_cast<double>(now) / static_cast<double>(std::max<std::size_t>(total, 1)),
                    kMeasuring);
  };
  parallel_for(threads, static_cast<int>((vertices + kAtOnce - 1) / kAtOnce), [&](int part) {
    const std::size_t first = part * kAtOnce, last = std::min(vertices, first + kAtOnce);
    for (std::size_t i = first; i < last && !progress.cancelled(); ++i)
      if (is_used[i])
        field.vertex_values_[i] =
            function(position_of[i], normals.at_position(static_cast<std::uint32_t>(i)));
    report(last - first);
  });
  parallel_for(threads, static_cast<int>(gridded.size()), [&](int which) {
    const std::uint32_t t = gridded[which];
    const Grid grid = field.grids_.at(t);
    const glm::vec3 a = corner(geometry, t, 0), ab = corner(geometry, t, 1) - a,
                    ac = corner(geometry, t, 2) - a;
    for (int i = 0; i <= grid.cuts; ++i)
      for (int j = 0; i + j <= grid.cuts && !progress.cancelled(); ++j) {
        const float b = static_cast<float>(i) / static_cast<float>(grid.cuts),
                    c = static_cast<float>(j) / static_cast<float>(grid.cuts);
        field.grid_values_[grid.first + index_in_grid(grid.cuts, i, j)] =
            function(a + b * ab + c * ac, normals.at(t, {1 - b - c, b, c}));
      }
    report(points_of(grid.cuts));
  });
  if (progress.cancelled()) return cancelled_problem();
  return field;
}

float SampledField::grid_at(const Grid& grid, const glm::vec3& weights) const {
  const float u = weights.y * static_cast<float>(grid.cuts),
              v = weights.z * static_cast<float>(grid.cuts);
  int i = std::clamp(static_cast<int>(u), 0, grid.cuts - 1);
  int j = std::clamp(static_cast<int>(v), 0, grid.cuts - 1 - i);
  const float du = std::clamp(u - static_cast<float>(i), 0.0f, 1.0f),
              dv = std::clamp(v - static_cast<float>(j), 0.0f, 1.0f);
  const auto value = [&](int di, int dj) {
    return grid_values_[grid.first + index_in_grid(grid.cuts, i + di, j + dj)];
  };
  if (du + dv <= 1 || i + j + 2 > grid.cuts)
    return mean_of_defined({value(0, 0), value(1, 0), value(0, 1)},
                           {std::max(0.0f, 1 - du - dv), du, dv});
  return mean_of_defined({value(1, 1), value(0, 1), value(1, 0)}, {du + dv - 1, 1 - du, 1 - dv});
}

float SampledField::at(std::uint32_t triangle, const glm::vec3& weights) const {
  if (const auto grid = grids_.find(triangle); grid != grids_.end())
    return grid_at(grid->second, weights);
  std::array<float, 3> values;
  for (std::size_t k = 0; k < 3; ++k)
    values[k] =
        vertex_values_[geometry_->vertices[geometry_->indices[3 * std::size_t{triangle} + k]]
                           .position_index];
  return mean_of_defined(values, weights);
}

}  // namespace strata::mesh
