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
// or the surface point nearest to a point of the world
using Place = std::variant<PixelPlace, glm::dvec3>;
// How an outline changes the selection of the outlines before it.
enum class Combination { add, subtract, intersect };
struct Outline {
  // the visible surface inside it in the camera's window (even-odd rule)
  Camera camera;
  std::vector<glm::dvec2> path;  // window pixels, origin top left; 3…4096 points
  bool through = false;          // hidden surface, too

  // Further outlines, each in the window of its own camera, combined in their order.
  struct Step {
    Combination combination = Combination::add;
    Camera camera;
    std::vector<glm::dvec2> path;
    bool through = false;
  };
  std::vector<Step> steps{};
};

}  // namespace strata::room
