#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "domain/scene/model.h"

namespace strata {

// Where the model's axes lie on the map. `east` and `north` are axes: as on a map where z is up,
// and so that east × north = up.
struct Compass {
  explicit Compass(const Model& model);
  glm::dvec3 east{1, 0, 0}, north{0, 1, 0};
  double turned_degrees = 0;  // true north from `north`, clockwise as seen from above
  bool is_known = false;      // the model says so, or its coordinates are those of a map

  glm::dvec3 true_north() const;
};

}  // namespace strata
