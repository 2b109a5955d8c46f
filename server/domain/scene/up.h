#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string_view>

namespace strata {

// The directions that can be up in a model: its axes and their opposites, as `Model::up` names
// them.
inline constexpr std::array<std::string_view, 6> kUpDirections{"x", "y", "z", "-x", "-y", "-z"};

bool is_up(std::string_view name);

// The axes of the front view, unit vectors in the world with right × into = up: `into` away from
// who looks, and north on the map that is the view from above. As the page has them
// (web-client/src/core/camera.ts). That of an axis' opposite is turned about `right` by 180°.
struct UpFrame {
  glm::dvec3 right{1, 0, 0}, into{0, 1, 0}, up{0, 0, 1};
};
UpFrame up_frame(std::string_view up);  // z for a name that is none

}  // namespace strata
