#include "render/edit/facing_limit.h"

#include <cmath>

namespace strata::render {

FacingLimit make_facing_limit(const Camera& camera, double max_angle_deg) {
  // The rows need no origin, because a translation does not change directions.
  const glm::dmat4 rows = glm::transpose(camera.projection * camera.view);
  const double cosine = max_angle_deg < 90 ? std::cos(glm::radians(max_angle_deg)) : 0.0;
  return {glm::vec3(rows[0]), glm::vec3(rows[1]), glm::vec3(rows[3]),
          glm::vec3(glm::dvec3(rows[3]) - glm::dvec3(rows[2])),
          static_cast<float>(cosine * cosine)};
}

}  // namespace strata::render
