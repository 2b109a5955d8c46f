#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/progress.h"
#include "mesh/parallel.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// A surface as approximately evenly spaced points, independent of the shapes of its triangles. All
// triangle pieces that are in the same cell of radius / 5 and face the same way form one sample. A
// neighborhood therefore has about 80 samples in a scan of any density. Noise finer than the cells
// is averaged, and the two faces of a thin wall stay separate. Positions are in model space.
// Immutable after construction and thread-safe.
class SurfaceSamples {
 public:
  struct Sample {
    glm::vec3 position, normal;  // mean, weighted by area
    float area;
    // The number of vertices that determine the sample. The sum over the surface is half the number
    // of triangles, which is the number of vertices of a closed surface. Less than 1 in triangles
    // that are larger than the cells.
    float vertices;
  };
  // The places of the pieces. `centers` cuts triangles that are larger than a cell. `vertices`
  // puts a third of each triangle at each of its corners, so that the scatter of the samples is
  // that of the vertices. It only cuts triangles that are larger than half the radius.
  enum class Pieces { centers, vertices };

  // Returns the smallest radius allowed for a mesh with this area (unit²) and bounding box. A
  // smaller radius would need tens of millions of samples.
  static double least_radius(double area, const glm::dvec3& extent);

  // Requires radius ≥ least_radius. Fails when cancelled. The result does not depend on the number
  // of threads. In addition to the memory of the result it needs about 60 bytes per piece of the
  // bands in progress and 4 bytes per triangle.
  static Result<SurfaceSamples> make(const Geometry& geometry, float radius, Progress& progress,
                                     int threads = background_threads(),
                                     Pieces pieces = Pieces::centers);

  float radius() const { return radius_; }
  std::size_t size() const { return samples_.size(); }

  // Calls visit(sample, squared distance) for each sample within the radius of `point` with a
  // normal within 80° of `normal`.
  template <class Visit>
  void near(const glm::vec3& point, const glm::vec3& normal, Visit&& visit) const {
    within_box(point - radius_, point + radius_, [&](const Sample& sample) {
      const glm::vec3 offset = sample.position - point;
      const float squared = glm::dot(offset, offset);
      if (squared <= radius_ * radius_ && glm::dot(sample.normal, normal) >= kMinCos)
        visit(sample, squared);
    });
  }

  // Calls visit(sample, t) for each sample in a cylinder with a normal within 80° of its `axis`.
  // The axis is a unit vector. The cylinder has the radius of the samples and extends along the
  // axis from point + from · axis to point + to · axis, without its end. `t` is the position of the
  // sample along the axis. Calls for adjacent cylinders visit each sample once.
  template <class Visit>
  void within_cylinder(const glm::vec3& point, const glm::vec3& axis, float from, float to,
                       Visit&& visit) const {
    const glm::vec3 a = point + from * axis, b = point + to * axis;
    const glm::vec3 around = radius_ * glm::sqrt(glm::max(glm::vec3(0), 1.0f - axis * axis));
    within_box(glm::min(a, b) - around, glm::max(a, b) + around, [&](const Sample& sample) {
      const glm::vec3 offset = sample.position - point;
      const float t = glm::dot(offset, axis);
      if (t >= from && t < to && glm::dot(offset, offset) - t * t <= radius_ * radius_ &&
          glm::dot(sample.normal, axis) >= kMinCos)
        visit(sample, t);
    });
  }

  // Returns true if there is no sample within kClearRadii radii of `point`. Can also return false
  // then. Much faster than a visit.
  bool is_clear_around(const glm::vec3& point) const {
    return !near_wide_cells_.contains(key_of(wide(cell_of(point))));
  }
  static constexpr int kClearRadii = 8;

 private:
  static constexpr float kMinCos = 0.17f;  // of 80°

  template <class Visit>
  void within_box(const glm::vec3& from, const glm::vec3& to, Visit&& visit) const {
    const glm::ivec3 low = cell_of(from), high = cell_of(to);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
          for (const Sample& sample : in_cell({x, y, z})) visit(sample);
  }

  friend class SampleBands;
  SurfaceSamples(const glm::vec3& low, float radius) : radius_(radius), low_(low) {}

  glm::ivec3 cell_of(const glm::vec3& point) const {
    return glm::ivec3(glm::floor((point - low_) / radius_)) + 1;
  }
  static std::uint64_t key_of(const glm::ivec3& cell) {
    return std::uint64_t(std::uint32_t(cell.x) & 0x1fffff) |
           std::uint64_t(std::uint32_t(cell.y) & 0x1fffff) << 21 |
           std::uint64_t(std::uint32_t(cell.z) & 0x1fffff) << 42;
  }
  // Returns the wide cell, of kClearRadii cells along each axis, that contains a cell.
  static glm::ivec3 wide(const glm::ivec3& cell) {
    return glm::ivec3(glm::floor(glm::vec3(cell) / float{kClearRadii}));
  }
  void find_near_wide_cells();
  std::span<const Sample> in_cell(const glm::ivec3& cell) const;

  float radius_;
  glm::vec3 low_;
  std::vector<Sample> samples_;  // the samples of one cell with the size of the radius are adjacent
  static constexpr std::uint32_t kUnplaced = 0xffffffffu;
  struct Range {
    std::uint32_t first = kUnplaced, count = 0;
  };
  std::unordered_map<std::uint64_t, Range> cells_;
  std::unordered_set<std::uint64_t> near_wide_cells_;  // with a sample in them or next to them
};

}  // namespace strata::mesh
