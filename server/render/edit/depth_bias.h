#pragma once

#include <optional>

#include "domain/scene/stroke.h"

namespace strata::render {

// The slope-aware bias lets a texel pass that lies behind the depth buffer by this share of the
// model's diagonal (scan noise within a pixel), plus the depth that the surface's own slope makes
// within half a pixel, up to so many times the first.
constexpr double kDepthBiasOfDiagonal = 1.5e-4;
constexpr double kDepthBiasSlopeFactor = 1.5;
constexpr double kDepthBiasSlopeLimit = 64.0;

// How much nearer than the depth buffer a texel counts as: `fixed`, or (1 + slope_limit) · scale /
// w² at most.
struct DepthBias {
  std::optional<double> fixed;
  double scale = 0, slope_factor = 0, slope_limit = 0;
};

// The stroke's fixed bias where it has one, else the slope-aware one.
DepthBias depth_bias_of(const StrokeBatch& stroke, double model_diagonal);

}  // namespace strata::render
