#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Returns a geometry of these triangles, three indices each, with the same parts. Its vertices and
// positions are those that the triangles use, numbered by first use.
Geometry with_triangles(const Geometry& source, std::span<const std::uint32_t> indices);

struct Collapsed {
  std::vector<std::uint32_t> indices;  // of vertices of the geometry
  float error = 0;                     // the largest quadric error, as a share of the extent
};
// Collapses edges to one of their ends until the geometry has at most `triangles` triangles, or
// until any further collapse would exceed `max_error` or tear a seam of the atlas (quadric error,
// meshoptimizer). So every vertex keeps its normal, color and texture coordinate, and vertices on a
// seam stay on the seam.
Collapsed collapse_edges(const Geometry& geometry, std::size_t triangles, float max_error);

// The largest quadric error of `simplify`, as a share of the model's extent.
constexpr float kMaxSimplifyError = 0.05f;

// Returns an upper limit of the memory in bytes that `simplify` needs, with its result.
std::uint64_t bytes_to_simplify(const Geometry& geometry);

// Returns a copy with at most `max_triangles` triangles by `collapse_edges`. Usually, the copy has
// nearly this number. Returns `invalid` at `max_triangles` if that number would exceed
// kMaxSimplifyError, tear seams, or remove pieces of the surface. The message then contains a
// number that is possible. Fails when cancelled, which it checks between steps: the first step, to
// a quarter of the triangles, needs some seconds for some million triangles.
Result<Geometry> simplify(const Geometry& geometry, std::size_t max_triangles, Progress& progress);

}  // namespace strata::mesh
