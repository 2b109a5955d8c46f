#pragma once

#include <glm/glm.hpp>

#include "core/error.h"

namespace strata {

// `museum`: three soft lights that follow the eye, and sky light. `headlight`: light from the eye.
// `raking`: light from one side, which shows relief. `unlit`: the colors without light.
enum class LightMode { museum, headlight, raking, unlit };

constexpr double kMaxExposure_ev = 3;

struct Light {
  LightMode mode = LightMode::museum;
  // For raking light: direction to the light, in the axes of the eye (x right, y up, z towards the
  // viewer).
  glm::dvec3 direction{-0.85, 0.40, 0.35};
  // Exposure of the surface, from -kMaxExposure_ev to kMaxExposure_ev. Layers keep the colors of
  // their legends.
  double exposure_ev = 0;
  // For raking light: the part of the light that comes from the eye, 0…1.
  double fill = 0;
  // For raking light: a factor for the opacity of the layers, 0…1.
  double layer_opacity = 1;
  bool operator==(const Light&) const = default;
};

// Returns the factor for the opacity of all layers in this light.
inline double opacity_of_layers(const Light& light) {
  return light.mode == LightMode::raking ? light.layer_opacity : 1;
}

// Returns an error for a direction of length 0 and for numbers out of range.
Result<void> validate(const Light& light, const std::string& field = "light");

}  // namespace strata
