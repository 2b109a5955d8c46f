#pragma once

#include <optional>

#include "domain/scene/stroke.h"

namespace strata::render {

// The slope-aware bias has two parts. The first is a share of the model's diagonal, for scan noise
// within a pixel. The second is the depth change of the surface within half a pixel, limited to a
// multiple of the first part.
constexpr double kDepthBiasOfDiagonal = 1.5e-4;
constexpr double kDepthBiasSlopeFactor = 1.5;
constexpr double kDepthBiasSlopeLimit = 64.0;

// The distance by which a texel is moved towards the eye before the comparison with the depth
// buffer: `fixed`, or at most (1 + slope_limit) · scale / w².
struct DepthBias {
  std::optional<double> fixed;
  double scale = 0, slope_factor = 0, slope_limit = 0;
};

// Returns the stroke's fixed bias if it has one, otherwise the slope-aware bias.
DepthBias depth_bias_of(const StrokeBatch& stroke, double model_diagonal);

}  // namespace strata::render
