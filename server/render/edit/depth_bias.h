#pragma once

#include <optional>

#include "domain/scene/stroke.h"

namespace strata::render {

// With the slope-aware bias, a texel passes that is behind the depth buffer by at most this share
// of the model's diagonal (scan noise within a pixel), plus the depth change of the surface within
// half a pixel, up to a multiple of the first.
constexpr double kDepthBiasOfDiagonal = 1.5e-4;
constexpr double kDepthBiasSlopeFactor = 1.5;
constexpr double kDepthBiasSlopeLimit = 64.0;

// The bias by which a texel counts as nearer in the comparison with the depth buffer: `fixed`, or
// at most (1 + slope_limit) · scale / w².
struct DepthBias {
  std::optional<double> fixed;
  double scale = 0, slope_factor = 0, slope_limit = 0;
};

// Returns the stroke's fixed bias if it has one, otherwise the slope-aware one.
DepthBias depth_bias_of(const StrokeBatch& stroke, double model_diagonal);

}  // namespace strata::render
