#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string_view>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The soft shadow of a model on a floor under its lowest point: a square map of the light that the
// model blocks. Positions are in model space.
struct ContactShadow {
  static constexpr int kSize = 128;  // texels on each side

  glm::vec3 corner{0};                      // of the first texel of the first row
  glm::vec3 along_row{0}, along_column{0};  // the sides of the square, which start at `corner`
  glm::vec3 up{0, 0, 1};                    // unit vector
  // row by row; 0: no shadow, 255: darkest. 0 at the border of the square
  std::array<std::uint8_t, std::size_t{kSize} * kSize> cover{};
};

// `up` is one of kUpDirections (domain/scene/up.h). The shadow of a part of the model is darker and
// sharper if the part is closer to the floor. Takes a few milliseconds for 100 000 triangles. For a
// large model, use a coarser copy. Returns null if the model has no extent perpendicular to `up`.
std::shared_ptr<const ContactShadow> contact_shadow(const Geometry& geometry, std::string_view up);

}  // namespace strata::mesh
