#pragma once

#include <vector>

#include "domain/layers/palette.h"
#include "domain/scene/camera.h"
#include "shared/features.h"

namespace strata::render {

// A line or a point on a model, as shown in pictures.
struct DrawnFeature {
  std::vector<glm::dvec3> places;  // world; one: a point
  Rgba color{};
};

// Widths of marks, in pixels of a camera's window.
inline constexpr double kLineWidth_px = 3, kPointWidth_px = 10, kFeatureCasing_px = 1.25;
// The largest distance of a mark's pixels from its position.
inline constexpr double kFeatureMargin_px = kPointWidth_px / 2 + kFeatureCasing_px + 1;

// How far a mark's point may be below the visible surface and still be visible, perpendicular to
// that surface: the larger of some pixels of the camera's window and of a length on the model. A
// line is stored as points between which the surface bulges by half a pixel of the view in which it
// was drawn: a share of the line's length bounds that, and for long lines a share of the model's
// size.
struct FeatureReach {
  double pixels = 1;
  double model_size = 0;  // diagonal of its box, world
};

// Returns the pieces of the marks in a picture of `width` × `height`: those in front of the eye
// whose pixels may be in it, and of them the parts kept by the section. Pieces have the same ends
// in every picture of the same scale, so that parts of a figure join.
std::vector<shader::FeatureSegment> project_features(const std::vector<DrawnFeature>& features,
                                                     const Camera& camera, int width, int height,
                                                     const FeatureReach& reach);

}  // namespace strata::render
