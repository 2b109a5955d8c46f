#pragma once

#include <glm/glm.hpp>

#include "core/error.h"

namespace strata {

// museum: a soft key light with fill and sky; headlight: from the eye; raking: from one side, which
// shows relief; unlit: the colors without light.
enum class LightMode { museum, headlight, raking, unlit };

struct Light {
  LightMode mode = LightMode::museum;
  // Raking light: direction to the light, in the eye's axes (x right, y up, z to the viewer).
  glm::dvec3 direction{-0.85, 0.40, 0.35};
  bool operator==(const Light&) const = default;
};

// Refuses a direction without length.
Result<void> validate(const Light& light, const std::string& field = "light");

}  // namespace strata
