#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "mesh/atlas/flat_pieces.h"
#include "mesh/atlas/unit_mesh.h"

namespace strata::mesh {

// A connected piece of surface that is laid flat by looking along `axis`.
struct Chart {
  glm::vec3 origin{0}, axis{0, 0, 1}, u{1, 0, 0}, v{0, 1, 0};
  bool uses_smoothed = true;  // projects the smoothed copy; single faces project the surface itself
  std::vector<std::uint32_t> faces;

  glm::vec2 project(glm::vec3 p) const {
    return {glm::dot(p - origin, u), glm::dot(p - origin, v)};
  }
};

struct ChartOptions {
  // largest angle between a face's averaged normal and the chart's axis
  float cone_degrees = 55;
  float smallest_footprint = 0.15f;  // of a face's area in the plane, relative to its area in space
  double texels_per_unit = 1000;     // density at which no two faces of a chart may share a texel
  // texels from a chart's seed to its farthest point; flat pieces may be larger
  int largest_half_side = 400;
  bool keeps_flat_pieces = true;  // the faces of a flat piece stay in one chart
  double progress_from = 0.1, progress_to = 0.7;
};

// Everything that growing and laying out charts needs to know of a mesh.
struct ChartSurface {
  const UnitMesh& mesh;
  std::vector<std::uint32_t> neighbours;
  std::vector<glm::vec3> smoothed;
  FaceFrames original_frames, smoothed_frames;
  std::vector<glm::vec3> trend_normals;
  FlatPieces flat;

  glm::vec3 corner(const Chart& chart, std::uint32_t face, int k) const {
    const std::uint32_t vertex = mesh.triangles[3 * face + k];
    return chart.uses_smoothed ? smoothed[vertex] : mesh.positions[vertex];
  }
};
ChartSurface make_chart_surface(const UnitMesh& mesh, int smoothing);

// Cuts the surface into charts: each grows from a seed by priority (faces that look along its axis
// and lie near first), takes a face only if that keeps it injective at texel level, and is grown
// again along its mean normal. A flat piece is taken as a whole, and one too large for that is a
// chart by itself. Then faces of tiny charts join neighbours that can take them. Every face ends in
// exactly one chart, every chart is connected. Empty when cancelled.
std::optional<std::vector<Chart>> grow_charts(const ChartSurface& surface,
                                              const ChartOptions& options, Progress& progress);

// Takes the given faces, with the flat pieces that they are of, out of their charts and cuts them
// into charts of their own, of several faces where `options` allow it; what a chart loses its
// connection by becomes several charts. Returns the number of the first new chart: the ones before
// it are parts of what was there. Empty when cancelled.
std::optional<std::size_t> split_off(const ChartSurface& surface,
                                     std::span<const std::uint32_t> faces,
                                     const ChartOptions& options, const Progress& progress,
                                     std::vector<Chart>& charts);

// Appends the connected parts of `chart` to `charts`. `pending`: one a face, all 0, and left so.
void append_connected_parts(const ChartSurface& surface, const Chart& chart,
                            std::vector<std::uint8_t>& pending, std::vector<Chart>& charts);

}  // namespace strata::mesh
