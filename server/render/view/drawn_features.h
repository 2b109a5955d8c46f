#pragma once

#include <vector>

#include "domain/layers/palette.h"
#include "domain/scene/camera.h"
#include "shared/features.h"

namespace strata::render {

// A line or a point on a model, as drawn in frames.
struct DrawnFeature {
  std::vector<glm::dvec3> places;  // in world space; one position: a point
  Rgba color{};
  int part = 0;  // of the model
};

// The widths of marks, in pixels of the camera's window.
inline constexpr double kLineWidth_px = 3, kPointWidth_px = 10, kFeatureCasing_px = 1.25;
// The largest distance of a mark's pixels from its position.
inline constexpr double kFeatureMargin_px = kPointWidth_px / 2 + kFeatureCasing_px + 1;

// The largest distance below the visible surface at which a mark's point is still visible. It is
// measured perpendicular to that surface. It is the larger of two limits: a number of pixels of the
// camera's window, and a length on the model. A line is stored as points. Between them, the surface
// can rise above the line by half a pixel of the view in which the line was drawn. A share of the
// line's length, and for long lines a share of the model's size, bounds this height.
struct FeatureReach {
  double pixels = 1;
  double model_size = 0;  // diagonal of its box, in world units
};
inline constexpr double kFeatureReach_px = 1;  // on the full mesh
// Returns the length on the model, for a line or, with one place, a point.
double reach_on_model(const std::vector<glm::dvec3>& places, double model_size);

// Returns the pieces of the marks that may be visible in a frame of `width` × `height` pixels.
// Omits hidden parts of the model, and what is behind the eye or removed by the section. The ends
// of the pieces depend only on the camera and the scale, so the bands of a figure match.
std::vector<shader::FeatureSegment> project_features(const std::vector<DrawnFeature>& features,
                                                     const Camera& camera, int width, int height,
                                                     const FeatureReach& reach);

}  // namespace strata::render
