#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "domain/scene/model.h"

namespace strata {

// The directions of the map for a model. `east` and `north` are axes of the model, x and y if z is
// up. East × north is always the up direction.
struct Compass {
  explicit Compass(const Model& model);
  glm::dvec3 east{1, 0, 0}, north{0, 1, 0};
  double turned_degrees = 0;  // clockwise angle from `north` to true north, seen from above
  bool is_known = false;      // the model has a north direction or map coordinates

  glm::dvec3 true_north() const;
};

}  // namespace strata
