#pragma once

#include <span>
#include <vector>

#include "domain/scene/stroke.h"
#include "shared/edit.h"

namespace strata::render {

constexpr std::size_t kMaxPathPoints = 4096;  // of one stroke batch

struct PixelBox {  // window pixels, origin lower left
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool overlaps(const PixelBox& other) const {
    return x0 <= other.x1 && other.x0 <= x1 && y0 <= other.y1 && other.y0 <= y1;
  }
};

// A stroke's path as segments in window pixels, with their boxes for culling.
struct ToolPath {
  std::vector<shader::EditSegment> segments;
  std::vector<PixelBox> boxes;  // of each segment with its tool
  PixelBox box;                 // of all
  // radius of the disc about the tool's center that is completely inside the tool, as a share of
  // its radius
  double inner_radius = 1;
};

// `radii_px` has one entry for each point, before the stroke's widths. Points at the same place are
// joined.
ToolPath make_tool_path(const StrokeBatch& stroke, std::span<const double> radii_px);

// The length of a model unit in view space: 1 unless the view matrix scales.
double view_scale(const Camera& camera);

// The camera's w (distance along its axis; 1 for orthographic) at the window depth `depth` (0…1).
double w_at_depth(const Camera& camera, double depth);

// Radius in window pixels under each path point for a radius in model units: radius_world · view
// scale · projection scale / w, with w from the depth under the point (1: no surface). A point off
// the surface uses the depth of the nearest path point on it, or `fallback_w` if no point is on it.
std::vector<double> radii_from_depths(const StrokeBatch& stroke, std::span<const float> depths,
                                      double fallback_w);

}  // namespace strata::render
