#include "domain/scene/light.h"

#include <cmath>

namespace strata {

Result<void> validate(const Light& light, const std::string& field) {
  const double length = glm::length(light.direction);
  if (!std::isfinite(length) || !(length > 1e-6))
    return fail(ErrorCode::invalid, "Light without a direction",
                "The direction of a light must be three finite numbers that are not all 0.",
                field + ".direction");
  return {};
}

}  // namespace strata
