#pragma once

#include <vector>

#include "domain/layers/palette.h"
#include "domain/scene/camera.h"
#include "shared/features.h"

namespace strata::render {

// Lines and points that lie on a model, as pictures show them.
struct DrawnFeature {
  std::vector<glm::dvec3> places;  // world; one: a point
  Rgba color{};
};

// How wide marks are, in pixels of a camera's window.
inline constexpr double kLineWidth_px = 3, kPointWidth_px = 10, kFeatureCasing_px = 1.25;
// A mark reaches no farther from its place.
inline constexpr double kFeatureMargin_px = kPointWidth_px / 2 + kFeatureCasing_px + 1;

// How far below the surface that is seen a mark's place may lie and still be visible, square to
// that surface: the larger of some pixels of the camera's window and of a length on the model. A
// line is stored as places between which the surface bulges by half a pixel of the view in which it
// was drawn: a share of its length bounds that, and a share of the model's size, long lines too.
struct FeatureReach {
  double pixels = 1;
  double model_size = 0;  // diagonal of its box, world
};

// The pieces of the marks in a picture of `width` × `height`: those in front of the eye whose
// pixels may lie in it, and of them what the section keeps. Pieces begin and end where they do in
// every picture of the same scale, so that parts of a figure join.
std::vector<shader::FeatureSegment> project_features(const std::vector<DrawnFeature>& features,
                                                     const Camera& camera, int width, int height,
                                                     const FeatureReach& reach);

}  // namespace strata::render
