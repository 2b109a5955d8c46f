#pragma once

#include <vector>

#include "core/camera.h"
#include "core/palette.h"
#include "shared/marks.h"

namespace strata::render {

// Lines and points that lie on a model, as pictures show them.
struct DrawnMark {
  std::vector<glm::dvec3> places;  // world; one: a point
  Rgba color{};
};

// How wide marks are, in pixels of a camera's window.
inline constexpr double kLineWidth_px = 3, kPointWidth_px = 10, kMarkCasing_px = 1.25;

// The segments of the marks in a picture of `width` × `height`: those in front of the eye, and of them what the section keeps.
// They are lifted towards the eye by `lift_px` pixels at their distance, since the surface between two places of a line may bulge.
std::vector<shader::MarkSegment> project_marks(const std::vector<DrawnMark>& marks, const Camera& camera, int width,
                                               int height, double lift_px);

}  // namespace strata::render
