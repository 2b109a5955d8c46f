#include "domain/scene/light.h"

#include <cmath>

namespace strata {

Result<void> validate(const Light& light, const std::string& field) {
  const double length = glm::length(light.direction);
  if (!std::isfinite(length) || !(length > 1e-6))
    return fail(ErrorCode::invalid, "Light without a direction",
                "The direction of a light must be three finite numbers that are not all 0.",
                field + ".direction");
  const auto in_range = [](double value, double low, double high) {
    return value >= low && value <= high;  // false for NaN
  };
  if (!in_range(light.exposure_ev, -kMaxExposure_ev, kMaxExposure_ev))
    return fail(ErrorCode::invalid, "Exposure out of range",
                "The exposure of a light must be from -3 to 3 EV.", field + ".exposure");
  if (!in_range(light.fill, 0, 1))
    return fail(ErrorCode::invalid, "Fill out of range", "The fill of a light must be from 0 to 1.",
                field + ".fill");
  if (!in_range(light.layer_opacity, 0, 1))
    return fail(ErrorCode::invalid, "Opacity out of range",
                "`layer_opacity`, a factor for the opacity of all layers, must be from 0 to 1.",
                field + ".layer_opacity");
  return {};
}

}  // namespace strata
