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

// One dispatched batch of a stroke's points: a swept tool joins consecutive points; a single point
// is a dab. A square is axis-aligned in the window, and swept means the union of the squares along
// the segment. The same holds for a texture: a point of the window is painted if the shape, moved
// and scaled continuously along the segment, covers it at any time. (As seen from the moving shape,
// the point moves along a straight line, also if the radius changes: it is painted if that line
// meets a cell of the shape.)
struct StrokeBatch {
  // world; `path` is in pixels of its width × height
  Camera camera;
  std::vector<glm::dvec2> path;  // window pixels, origin top left; 1…4096 points
  ToolShape shape = ToolShape::disc;
  std::shared_ptr<const ShapeTexture> texture;  // of ToolShape::texture
  // > 0: radius in window pixels; 0: radius_world is used
  double radius_px = 0;
  // radius in model units around the surface point under each path point, measured in the plane
  // facing the camera at that point's depth
  double radius_world = 0;
  // factor of the radius per path point, above 0, at most 1 (a pen's pressure); empty: 1
  std::vector<double> widths;
  bool through = false;  // paint hidden surface, too: no depth test
  // How much nearer than the depth buffer a texel counts as, in window depth (0…1), as in the
  // paper. Absent: the bias follows the model's size and the slope of the visible surface, so that
  // it does not depend on the camera's planes.
  std::optional<double> fixed_depth_bias;
  // Above 0, at most 90: more oblique surface is not painted. The angle is between the direction to
  // the eye and the surface normal in the texel's pixel. Absent: no limit. Not with `through`,
  // since hidden surface has no pixel.
  std::optional<double> max_angle_deg;
  bool erase = false;
  std::uint32_t value_bits = 0;  // of the layer's type; ignored when erasing
};

}  // namespace strata
