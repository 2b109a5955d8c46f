#include "domain/scene/compass.h"

#include <cmath>
#include <cstdlib>

#include "domain/scene/up.h"

namespace strata {

Compass::Compass(const Model& model) : is_known(!model.crs.empty()) {
  const UpFrame frame = up_frame(model.up);
  east = frame.right;
  north = frame.into;
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
