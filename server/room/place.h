#pragma once

#include <glm/glm.hpp>
#include <variant>
#include <vector>

#include "domain/scene/camera.h"

namespace strata::room {

struct PixelPlace {  // the surface at a pixel of the camera's window
  Camera camera;
  double x = 0, y = 0;
};
// Either a pixel, or the surface point nearest to a point in world coordinates.
using Place = std::variant<PixelPlace, glm::dvec3>;
// The effect of an outline on the selection that the previous outlines made.
enum class Combination { add, subtract, intersect };
struct Outline {
  // Selects the visible surface inside the path in the camera's window (even-odd rule).
  Camera camera;
  std::vector<glm::dvec2> path;  // window pixels, origin top left; 3…4096 points
  bool through = false;          // also selects hidden surface

  // Further outlines, which are combined in this order. Each outline is in the window of its own
  // camera.
  struct Step {
    Combination combination = Combination::add;
    Camera camera;
    std::vector<glm::dvec2> path;
    bool through = false;
  };
  std::vector<Step> steps{};
};

}  // namespace strata::room
