#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <unordered_map>
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
  };

  // Returns the smallest radius allowed for a mesh with this area (unit²) and bounding box. A
  // smaller radius would need tens of millions of samples.
  static double least_radius(double area, const glm::dvec3& extent);

  // Requires radius ≥ least_radius. Fails when cancelled. The result does not depend on the number
  // of threads. In addition to the memory of the result it needs about 60 bytes per piece of the
  // bands in progress and 4 bytes per triangle.
  static Result<SurfaceSamples> make(const Geometry& geometry, float radius, Progress& progress,
                                     int threads = background_threads());

  float radius() const { return radius_; }
  std::size_t size() const { return samples_.size(); }

  // Calls visit(sample, squared distance) for each sample within the radius of `point` with a
  // normal within 80° of `normal`.
  template <class Visit>
  void near(const glm::vec3& point, const glm::vec3& normal, Visit&& visit) const {
    constexpr float kMinCos = 0.17f;
    const glm::ivec3 low = cell_of(point - radius_), high = cell_of(point + radius_);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
          for (const Sample& sample : in_cell({x, y, z})) {
            const glm::vec3 offset = sample.position - point;
            const float squared = glm::dot(offset, offset);
            if (squared <= radius_ * radius_ && glm::dot(sample.normal, normal) >= kMinCos)
              visit(sample, squared);
          }
  }

 private:
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
  std::span<const Sample> in_cell(const glm::ivec3& cell) const;

  float radius_;
  glm::vec3 low_;
  std::vector<Sample> samples_;  // the samples of one cell with the size of the radius are adjacent
  static constexpr std::uint32_t kUnplaced = 0xffffffffu;
  struct Range {
    std::uint32_t first = kUnplaced, count = 0;
  };
  std::unordered_map<std::uint64_t, Range> cells_;
};

}  // namespace strata::mesh
