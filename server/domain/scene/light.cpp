#include "domain/scene/light.h"

#include <cmath>

namespace strata {

Result<void> validate(const Light& light, const std::string& field) {
  const double length = glm::length(light.direction);
  if (!std::isfinite(length) || !(length > 1e-6))
    return fail(ErrorCode::invalid, "Light without a direction",
                "A light's direction is three finite numbers, not all 0.", field + ".direction");
  return {};
}

}  // namespace strata
