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

// One dispatched batch of a stroke's points. A swept tool connects consecutive points, and a single
// point is a dab. A square is aligned with the axes of the window. The swept area is the union of
// the squares along the segment. A brush shape in a texture is also swept: it moves and scales
// continuously along the segment, and paints each point of the window that it covers at any time.
// (Relative to the moving shape, the point moves along a straight line, even if the radius changes.
// The point is painted if this line crosses a cell of the shape.)
struct StrokeBatch {
  // In world coordinates. The pixels of `path` refer to the camera's width × height.
  Camera camera;
  std::vector<glm::dvec2> path;  // window pixels, origin top left; 1…4096 points
  ToolShape shape = ToolShape::disc;
  std::shared_ptr<const ShapeTexture> texture;  // for ToolShape::texture
  // The radius in window pixels if it is above 0. If it is 0, radius_world is used.
  double radius_px = 0;
  // The radius in model units around the surface point under each path point. It is measured in the
  // plane that faces the camera at the depth of the surface point.
  double radius_world = 0;
  // A factor for the radius at each path point (a pen's pressure), above 0 and at most 1. Empty: 1.
  std::vector<double> widths;
  bool through = false;  // also paint hidden surface, without a depth test
  // The bias of the depth test, in window depth (0…1), as in the TEA paper: each texel is tested as
  // if it were nearer by this amount. If absent, the bias depends on the size of the model and the
  // slope of the visible surface. It does not depend on the near and far planes of the camera.
  std::optional<double> fixed_depth_bias;
  // Above 0, at most 90. Surface at a more oblique angle is not painted. The angle is between the
  // direction to the eye and the surface normal in the pixel of the texel. If absent, there is no
  // limit. Must be absent with `through`, because hidden surface has no pixel.
  std::optional<double> max_angle_deg;
  bool erase = false;
  std::uint32_t value_bits = 0;  // in the type of the layer; ignored when erasing
};

}  // namespace strata
