#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "core/error.h"

namespace strata {

constexpr int kMaxViewSize = 8192;            // pixels per side of a camera's window
constexpr std::size_t kMaxSectionPlanes = 6;  // a box

// OpenGL clip space, world coordinates in double. Pixels: origin top left, y down, centers at +0.5.
struct Camera {
  glm::dmat4 view{1.0};
  glm::dmat4 projection{1.0};
  int width = 0;
  int height = 0;
  // Planes in world coordinates that cut the model open, at most kMaxSectionPlanes: points with a x
  // + b y + c z + d < 0 for one of them are neither seen nor painted.
  std::vector<glm::dvec4> section{};
  bool operator==(const Camera&) const = default;
};

// Refuses sizes outside 1…kMaxViewSize, non-finite and singular matrices, planes without a
// direction and too many planes; `field` prefixes the named field.
Result<void> validate(const Camera& camera, const std::string& field = "camera");

bool is_orthographic(const Camera& camera);
glm::dvec3 eye_in_world(const Camera& camera);

// Float matrix from model space (world minus origin) to clip space, multiplied in double.
glm::mat4 clip_from_model(const Camera& camera, const glm::dvec3& origin);

// The section in model space, with unit normals; absent planes keep everything.
using SectionPlanes = std::array<glm::vec4, kMaxSectionPlanes>;
SectionPlanes section_in_model(const Camera& camera, const glm::dvec3& origin);

// If true, a visible back of a surface is a solid's inside. (Without perspective the eye is
// infinitely far.)
bool eye_is_cut_away(const Camera& camera);

// Returns the camera of some rows of the window, from the top: it shows the same there as the whole
// camera. `rows` above 0.
Camera camera_of_rows(const Camera& camera, int top, int rows);

struct Ray {
  glm::dvec3 origin;     // on the near plane, world
  glm::dvec3 direction;  // unit length
};
Ray ray_through_pixel(const Camera& camera, double x, double y);

// The part of a ray that the section keeps, as distances from its origin; empty if begin > end.
struct RaySpan {
  double begin = 0, end = 0;
};
RaySpan uncut_span(const Camera& camera, const Ray& ray);

}  // namespace strata
