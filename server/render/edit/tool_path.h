#pragma once

#include <span>
#include <vector>

#include "domain/scene/stroke.h"
#include "shared/edit.h"

namespace strata::render {

constexpr std::size_t kMaxPathPoints = 4096;  // limit for one stroke batch

struct PixelBox {  // in window pixels, origin lower left
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool overlaps(const PixelBox& other) const {
    return x0 <= other.x1 && other.x0 <= x1 && y0 <= other.y1 && other.y0 <= y1;
  }
};

// The path of a stroke as segments in window pixels, with their boxes for culling.
struct ToolPath {
  std::vector<shader::EditSegment> segments;
  std::vector<PixelBox> boxes;  // boxes of the segments, including the tool's radius
  PixelBox box;                 // box of all segments
  // The radius of the largest disc that is inside the tool and shares its center, as a share of the
  // tool's radius.
  double inner_radius = 1;
};

// Makes the segments of a stroke. `radii_px` contains one radius for each point, without the
// stroke's widths. Consecutive points with the same position and radius are joined.
ToolPath make_tool_path(const StrokeBatch& stroke, std::span<const double> radii_px);

// Returns the length of a model unit in view space: 1 unless the view matrix scales.
double view_scale(const Camera& camera);

// Returns w at the window depth `depth` (0…1): the distance along the camera's axis, or 1 for an
// orthographic camera.
double w_at_depth(const Camera& camera, double depth);

// Returns the radius in window pixels at each path point, for a radius in model units: radius_world
// · view scale · projection scale / w. The depth under the point determines w. A depth of 1 means
// that there is no surface. Such a point uses the depth of the nearest path point on the surface,
// or `fallback_w` if no point is on the surface.
std::vector<double> radii_from_depths(const StrokeBatch& stroke, std::span<const float> depths,
                                      double fallback_w);

}  // namespace strata::render
