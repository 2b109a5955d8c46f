#include "render/edit/stroke_painter.h"

#include <glm/gtc/matrix_transform.hpp>

namespace strata::render {

StrokePainter::PathPixels StrokePainter::path_pixels() const {
  PathPixels found;
  if (stroke_.radius_px > 0) return found;
  for (std::size_t i = 0; i < stroke_.path.size(); ++i) {
    const glm::dvec2 p = stroke_.path[i];
    if (p.x < 0 || p.y < 0 || p.x >= stroke_.camera.width || p.y >= stroke_.camera.height) continue;
    found.pixels.emplace_back(static_cast<int>(p.x),
                              stroke_.camera.height - 1 - static_cast<int>(p.y));
    found.points.push_back(i);
  }
  return found;
}

ToolPath StrokePainter::make_path(const mesh::Geometry& geometry, const PathPixels& at,
                                  std::span<const float> depths) const {
  const std::size_t count = stroke_.path.size();
  if (stroke_.radius_px > 0)
    return make_tool_path(stroke_, std::vector<double>(count, stroke_.radius_px));
  std::vector<float> of_points(count, 1.0f);
  for (std::size_t i = 0; i < at.points.size(); ++i) of_points[at.points[i]] = depths[i];
  const glm::dvec3 center = (glm::dvec3(geometry.box_min) + glm::dvec3(geometry.box_max)) * 0.5;
  const double center_w = (clip_from_model(geometry) * glm::dvec4(center, 1)).w;
  return make_tool_path(stroke_,
                        radii_from_depths(stroke_, of_points, center_w > 0 ? center_w : 1.0));
}

DepthBias StrokePainter::depth_bias(const mesh::Geometry& geometry) const {
  return depth_bias_of(stroke_,
                       glm::length(glm::dvec3(geometry.box_max) - glm::dvec3(geometry.box_min)));
}

glm::dmat4 StrokePainter::clip_from_model(const mesh::Geometry& geometry) const {
  return stroke_.camera.projection * stroke_.camera.view *
         glm::translate(glm::dmat4(1.0), geometry.origin);
}

}  // namespace strata::render
