#pragma once

#include <glm/glm.hpp>

#include "core/error.h"

namespace strata {

// museum: three soft lights that follow the eye, and sky; headlight: from the eye; raking: from one
// side, which shows relief; unlit: the colors without light.
enum class LightMode { museum, headlight, raking, unlit };

constexpr double kMaxExposure_ev = 3;

struct Light {
  LightMode mode = LightMode::museum;
  // Raking light: direction to the light, in the eye's axes (x right, y up, z to the viewer).
  glm::dvec3 direction{-0.85, 0.40, 0.35};
  // Of the surface, -kMaxExposure_ev to kMaxExposure_ev. Layers keep the colors of their legends.
  double exposure_ev = 0;
  // Raking light: the share of the light that comes from the eye instead, 0…1.
  double fill = 0;
  // Raking light: factor of the opacity of the layers, 0…1.
  double layer_opacity = 1;
  bool operator==(const Light&) const = default;
};

// The factor of the opacity of all layers in this light.
inline double opacity_of_layers(const Light& light) {
  return light.mode == LightMode::raking ? light.layer_opacity : 1;
}

// Refuses a direction without length and numbers out of range.
Result<void> validate(const Light& light, const std::string& field = "light");

}  // namespace strata
