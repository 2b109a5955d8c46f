#include "core/compass.h"

#include <cmath>
#include <cstdlib>

namespace strata {

Compass::Compass(const Model& model) : is_known(!model.crs.empty()) {
  if (model.up == "x") east = {0, 1, 0};
  north = model.up == "x" ? glm::dvec3(0, 0, 1) : model.up == "y" ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
  char* end = nullptr;
  const double degrees = std::strtod(model.north.c_str(), &end);
  if (model.north.empty() || *end != '\0' || !std::isfinite(degrees)) return;
  turned_degrees = degrees;
  is_known = true;
}

glm::dvec3 Compass::true_north() const {
  const double angle = glm::radians(turned_degrees);
  return std::cos(angle) * north + std::sin(angle) * east;
}

}  // namespace strata
