#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "domain/scene/camera.h"

namespace strata {

class ShapeTexture;  // media/shape_texture.h

enum class ToolShape { disc, square, texture };

// One dispatched batch of a stroke's points: consecutive points are joined by a swept tool, a
// single point is a dab. A square is axis-aligned in the window, and swept means the union of the
// squares along the segment. So is a texture: a point of the window is under a swept shape where
// the shape, moved and scaled along the segment without a step, covers it at any time. (As seen
// from the moving shape, the point goes along a straight line, also where the radius changes: the
// point is under the tool where that line meets a cell of the shape.)
struct StrokeBatch {
  // world; its width × height is the window that the path's pixels are of
  Camera camera;
  std::vector<glm::dvec2> path;  // window pixels, origin top left; 1…4096 points
  ToolShape shape = ToolShape::disc;
  std::shared_ptr<const ShapeTexture> texture;  // of ToolShape::texture
  // > 0: radius in window pixels; 0: radius_world is used
  double radius_px = 0;
  // radius in model units around the surface point under each path point, measured
  // in the plane facing the camera at that point's depth
  double radius_world = 0;
  // of the radius, one a path point, above 0, 1 at most (a pen's pressure); empty: 1
  std::vector<double> widths;
  bool through = false;  // paint what is hidden, too: no depth test
  // How much nearer than the depth buffer a texel counts as, in window depth (0…1), as the paper
  // has it. Absent: the bias follows the model's size and the slope of what is seen, so that it
  // does not depend on the camera's planes.
  std::optional<double> fixed_depth_bias;
  // Above 0, 90 at most: what the camera sees at more of a slant is not painted. The angle is that
  // between the direction to the eye and the normal of the surface in the texel's pixel. Absent: no
  // limit. Not with `through`: what is hidden has no pixel.
  std::optional<double> max_angle_deg;
  bool erase = false;
  std::uint32_t value_bits = 0;  // of the layer's type; ignored when erasing
};

}  // namespace strata
