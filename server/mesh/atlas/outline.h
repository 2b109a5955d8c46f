#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/atlas/charts.h"

namespace strata::mesh {

// The rim of a chart in its plane, rotated so that its bounding box has the smallest area. The
// outline is squeezed if it was too long. Its lower left corner is at 0.
struct Outline {
  std::vector<glm::vec2> segments;  // two points each, with the chart on the left, in any order
  glm::vec2 size{0};                // of the box, in units of the plane
  float cosine = 1, sine = 0;       // of the rotation
  glm::vec2 scale{1};               // applied after the rotation
  glm::vec2 low{0};                 // the box's corner, after rotation and scaling

  glm::vec2 from_chart(glm::vec2 p) const {
    return glm::vec2(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y) * scale - low;
  }

  // Scales the outline by these factors.
  void squeeze(glm::vec2 factors);
};

// `plane` has a point for every corner of the mesh and comes from `flatten`. The result contains
// all edges of the chart's faces.
Outline make_outline_of(const Chart& chart, std::span<const glm::vec2> plane);
std::vector<Outline> make_outlines(const ChartSurface& surface, std::span<const Chart> charts,
                                   std::span<const glm::vec2> plane);

}  // namespace strata::mesh
