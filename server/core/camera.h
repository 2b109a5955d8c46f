#pragma once

#include <glm/glm.hpp>

#include "core/problem.h"

namespace strata {

constexpr int kMaxViewSize = 8192;  // pixels a side of a camera's window

// OpenGL clip space, world coordinates in double. Pixels: origin top left, y down, centres at +0.5.
struct Camera {
  glm::dmat4 view{1.0};
  glm::dmat4 projection{1.0};
  int width = 0;
  int height = 0;
  bool operator==(const Camera&) const = default;
};

// Refuses sizes out of 1…kMaxViewSize, non-finite and singular matrices; `field` prefixes the named field.
Result<void> validate(const Camera& camera, const std::string& field = "camera");

bool is_orthographic(const Camera& camera);
glm::dvec3 eye_in_world(const Camera& camera);

// Float matrix from model space (world minus origin) to clip space, multiplied in double.
glm::mat4 clip_from_model(const Camera& camera, const glm::dvec3& origin);

struct Ray {
  glm::dvec3 origin;     // on the near plane, world
  glm::dvec3 direction;  // unit length
};
Ray ray_through_pixel(const Camera& camera, double x, double y);

}  // namespace strata
