#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/camera.h"

namespace strata {

enum class ToolShape { disc, square };

// One dispatched batch of a stroke's points: consecutive points are joined by a swept tool, a single point is a dab.
// A square is axis-aligned in the window, and swept means the union of the squares along the segment.
struct StrokeBatch {
  Camera camera;                 // world; its width × height is the window that the path's pixels are of
  std::vector<glm::dvec2> path;  // window pixels, origin top left; 1…4096 points
  ToolShape shape = ToolShape::disc;
  double radius_px = 0;     // > 0: radius in window pixels; 0: radius_world is used
  double radius_world = 0;  // radius in model units around the surface point under each path point, measured
                            // in the plane facing the camera at that point's depth
  bool through = false;     // paint what is hidden, too: no depth test
  // How much nearer than the depth buffer a texel counts as, in window depth (0…1), as the paper has it. Absent: the bias follows
  // the model's size and the slope of what is seen, so that it does not depend on the camera's planes.
  std::optional<double> fixed_depth_bias;
  bool erase = false;
  std::uint32_t value_bits = 0;  // of the layer's type; ignored when erasing
};

}  // namespace strata
