#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "domain/scene/model.h"

namespace strata {

// The directions of the model's axes on the map. `east` and `north` are axes: as on a map if z is
// up, and always with east × north = up.
struct Compass {
  explicit Compass(const Model& model);
  glm::dvec3 east{1, 0, 0}, north{0, 1, 0};
  double turned_degrees = 0;  // true north from `north`, clockwise as seen from above
  bool is_known = false;      // the model has a north, or map coordinates

  glm::dvec3 true_north() const;
};

}  // namespace strata
