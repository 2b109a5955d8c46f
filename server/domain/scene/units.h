#pragma once

#include "domain/scene/model.h"

namespace strata {

// Convert between millimeters on the object and the unit of the model.
inline double in_model_units(double millimetres, Unit unit) {
  return millimetres * 0.001 / metres_per(unit);
}
inline double in_millimetres(double length, Unit unit) { return length * metres_per(unit) * 1000; }

}  // namespace strata
