#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/progress.h"
#include "mesh/parallel.h"
#include "mesh/surface/geometry.h"
#include "mesh/surface/surface_normals.h"

namespace strata::mesh {

// Returns the value at a point of a surface from its position and normal in model space. NaN means
// no value. The function is called on several threads at the same time.
using PointFunction = std::function<float(const glm::vec3& position, const glm::vec3& normal)>;

// A function of points, evaluated at the vertices of a mesh and interpolated between them. A
// triangle with an edge longer than `spacing` gets its own grid of points, so a coarse mesh loses
// no detail. Immutable after construction and thread-safe.
class SampledField {
 public:
  // `spacing` must be positive. It is widened if the grids would have more than four million
  // points. Fails when cancelled.
  static Result<SampledField> make(std::shared_ptr<const Geometry> geometry,
                                   const SurfaceNormals& normals, float spacing,
                                   const PointFunction& function, Progress& progress,
                                   int threads = background_threads());

  // The interpolation ignores corners without a value. Returns NaN if no corner has a value.
  float at(std::uint32_t triangle, const glm::vec3& weights) const;

 private:
  struct Grid {
    std::uint32_t first;  // into grid_values_
    int cuts;             // (cuts + 1)(cuts + 2)/2 points: rows with a constant second weight
  };
  static int index_in_grid(int cuts, int i, int j) { return i * (2 * (cuts + 1) - i + 1) / 2 + j; }
  float grid_at(const Grid& grid, const glm::vec3& weights) const;

  std::shared_ptr<const Geometry> geometry_;
  std::vector<float> vertex_values_;               // for each welded position
  std::unordered_map<std::uint32_t, Grid> grids_;  // by triangle
  std::vector<float> grid_values_;
};

}  // namespace strata::mesh
