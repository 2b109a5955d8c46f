#include "render/edit/tool_path.h"

#include <algorithm>
#include <cmath>
#include "media/shape_texture.h"

namespace strata::render {
namespace {

// A radius that covers any window. Its square does not overflow float.
constexpr double kMaxRadius_px = 1e9;
// A radius that covers no texel but is not zero.
constexpr double kMinRadius_px = 1e-3;

PixelBox join(const PixelBox& a, const PixelBox& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

shader::EditSegment make_segment(glm::dvec2 a, glm::dvec2 b, double ra, double rb,
                                 ToolShape shape) {
  double length = glm::length(b - a);
  double shift = 0;
  if (shape == ToolShape::disc && length > 0 && ra != rb) {
    const double slope = (rb - ra) / length;
    if (std::abs(slope) >= 1) {  // one disc contains the other
      if (rb > ra) a = b;
      b = a;
      ra = rb = std::max(ra, rb);
      length = 0;
    } else {
      shift = slope / std::sqrt(1 - slope * slope);
    }
  }
  return {glm::vec4(glm::vec2(a), glm::vec2(b)), glm::vec4(ra, rb, shift, length)};
}

PixelBox box_of(const shader::EditSegment& s) {
  const double radius = std::max(s.tool.x, s.tool.y);
  return {std::min(s.ends.x, s.ends.z) - radius, std::min(s.ends.y, s.ends.w) - radius,
          std::max(s.ends.x, s.ends.z) + radius, std::max(s.ends.y, s.ends.w) + radius};
}

}  // namespace

ToolPath make_tool_path(const StrokeBatch& stroke, std::span<const double> radii_px) {
  ToolPath path;
  if (stroke.shape == ToolShape::texture) path.inner_radius = stroke.texture->inner_radius();
  const auto point = [&](std::size_t i) {
    return glm::dvec2(stroke.path[i].x, stroke.camera.height - stroke.path[i].y);
  };
  const auto radius = [&](std::size_t i) {
    const double width = stroke.widths.empty() ? 1 : stroke.widths[i];
    return std::clamp(radii_px[i] * width, kMinRadius_px, kMaxRadius_px);
  };
  std::size_t from = 0;
  for (std::size_t i = 1; i < stroke.path.size(); ++i) {
    if (point(i) == point(from) && radius(i) == radius(from)) continue;
    path.segments.push_back(
        make_segment(point(from), point(i), radius(from), radius(i), stroke.shape));
    from = i;
  }
  if (path.segments.empty())
    path.segments.push_back(make_segment(point(0), point(0), radius(0), radius(0), stroke.shape));
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    path.boxes.push_back(box_of(path.segments[i]));
    const PixelBox& box = path.boxes.back();
    path.box = i == 0 ? box : join(path.box, box);
  }
  return path;
}

double view_scale(const Camera& camera) {
  return std::cbrt(std::abs(glm::determinant(glm::dmat3(camera.view))));
}

double w_at_depth(const Camera& camera, double depth) {
  const auto& p = camera.projection;
  const double z = 2 * depth - 1;
  const double z_in_view = (p[3][2] - z * p[3][3]) / (z * p[2][3] - p[2][2]);
  return p[2][3] * z_in_view + p[3][3];
}

std::vector<double> radii_from_depths(const StrokeBatch& stroke, std::span<const float> depths,
                                      double fallback_w) {
  const std::size_t count = stroke.path.size();
  const double scale = view_scale(stroke.camera) * 0.5 * stroke.camera.height *
                       std::abs(stroke.camera.projection[1][1]);
  std::vector<double> ws(count, 0);
  std::vector<std::size_t> distance(count, count);  // to the path point whose depth is used
  const auto spread = [&](std::size_t i, std::size_t from) {
    if (distance[from] + 1 < distance[i]) {
      distance[i] = distance[from] + 1;
      ws[i] = ws[from];
    }
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (depths[i] >= 1) continue;
    ws[i] = w_at_depth(stroke.camera, depths[i]);
    distance[i] = 0;
  }
  for (std::size_t i = 1; i < count; ++i) spread(i, i - 1);
  for (std::size_t i = count; i-- > 1;) spread(i - 1, i);
  std::vector<double> radii(count);
  for (std::size_t i = 0; i < count; ++i)
    radii[i] = stroke.radius_world * scale / (distance[i] < count ? ws[i] : fallback_w);
  return radii;
}

}  // namespace strata::render
