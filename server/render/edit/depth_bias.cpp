#include "render/edit/depth_bias.h"

#include <cmath>

#include "render/edit/tool_path.h"

namespace strata::render {

// Per unit of distance along the camera's axis, window depth changes by |P22 P33 - P32 P23| / (2
// w²). The scale of the view matrix converts model units to view units.
DepthBias depth_bias_of(const StrokeBatch& stroke, double model_diagonal) {
  DepthBias bias;
  bias.fixed = stroke.fixed_depth_bias;
  const auto& p = stroke.camera.projection;
  const double depth_per_unit = 0.5 * std::abs(p[2][2] * p[3][3] - p[3][2] * p[2][3]);
  bias.scale = kDepthBiasOfDiagonal * model_diagonal * view_scale(stroke.camera) * depth_per_unit;
  bias.slope_factor = kDepthBiasSlopeFactor;
  bias.slope_limit = kDepthBiasSlopeLimit;
  return bias;
}

}  // namespace strata::render
