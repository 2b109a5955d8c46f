#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string_view>

namespace strata {

// The possible up directions of a model, as in `Model::up`: the axes and their opposites.
inline constexpr std::array<std::string_view, 6> kUpDirections{"x", "y", "z", "-x", "-y", "-z"};

bool is_up(std::string_view name);

// The axes of the front view, as unit vectors in the world with right × into = up. `into` points
// away from the viewer; in the view from above, it points to the north of the map. The web client
// uses the same axes (web-client/src/math/camera.ts). The axes for -x, -y and -z are those for x, y
// and z, rotated about `right` by 180°.
struct UpFrame {
  glm::dvec3 right{1, 0, 0}, into{0, 1, 0}, up{0, 0, 1};
};
UpFrame up_frame(std::string_view up);  // uses z for other names

}  // namespace strata
