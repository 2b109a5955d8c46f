#pragma once

#include <glm/glm.hpp>
#include <variant>
#include <vector>

#include "domain/scene/camera.h"

namespace strata::room {

struct PixelPlace {  // what the camera shows there
  Camera camera;
  double x = 0, y = 0;
};
// or the surface point nearest to a point of the world
using Place = std::variant<PixelPlace, glm::dvec3>;
struct Outline {
  // what is seen inside it in the camera's window (even-odd rule)
  Camera camera;
  std::vector<glm::dvec2> path;  // window pixels, origin top left; 3…4096 points
  bool through = false;          // what is hidden, too
};

}  // namespace strata::room
