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

// A connected piece of surface that is flattened by projection along `axis`.
struct Chart {
  glm::vec3 origin{0}, axis{0, 0, 1}, u{1, 0, 0}, v{0, 1, 0};
  bool uses_smoothed = true;  // false for single faces, which project the original surface
  std::vector<std::uint32_t> faces;

  glm::vec2 project(glm::vec3 p) const {
    return {glm::dot(p - origin, u), glm::dot(p - origin, v)};
  }
};

struct ChartOptions {
  // largest angle between a face's averaged normal and the chart's axis
  float cone_degrees = 55;
  float smallest_footprint = 0.15f;  // ratio of a face's area in the plane to its area in space
  double texels_per_unit = 1000;     // at which no two faces of a chart may share a texel
  // texels from a chart's seed to its farthest point; flat pieces may be larger
  int largest_half_side = 400;
  bool keeps_flat_pieces = true;  // the faces of a flat piece stay in one chart
  double progress_from = 0.1, progress_to = 0.7;
};

// The data of a mesh for growing charts and laying them out.
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

// Cuts the surface into charts. Each chart grows from a seed by priority: faces near the seed with
// normals close to the chart's axis come first. The chart accepts a face only if the chart stays
// injective at texel level. The chart is then grown again along its mean normal. A flat piece is
// added as a whole, or becomes its own chart if it is too large. Finally, faces of tiny charts join
// neighboring charts that can accept them. In the result every face is in exactly one chart, and
// every chart is connected. The result is empty when cancelled.
std::optional<std::vector<Chart>> grow_charts(const ChartSurface& surface,
                                              const ChartOptions& options, Progress& progress);

// Removes the given faces and their flat pieces from their charts and cuts them into new charts. A
// new chart has several faces if `options` allow it. A chart that is no longer connected becomes
// several charts. Returns the number of the first new chart. The charts before it are parts of
// existing charts. The result is empty when cancelled.
std::optional<std::size_t> split_off(const ChartSurface& surface,
                                     std::span<const std::uint32_t> faces,
                                     const ChartOptions& options, const Progress& progress,
                                     std::vector<Chart>& charts);

// Appends the connected parts of `chart` to `charts`. `pending` has one entry per face. All entries
// are 0 before and after the call.
void append_connected_parts(const ChartSurface& surface, const Chart& chart,
                            std::vector<std::uint8_t>& pending, std::vector<Chart>& charts);

}  // namespace strata::mesh
