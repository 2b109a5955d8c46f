#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "core/error.h"
#include "domain/scene/model_part.h"

namespace strata {

constexpr int kMaxViewSize = 8192;            // pixels per side of the camera's window
constexpr std::size_t kMaxSectionPlanes = 6;  // enough for a box

// OpenGL clip space, with world coordinates in double. The pixel origin is at the top left, y
// points down, and pixel centers are at +0.5.
struct Camera {
  glm::dmat4 view{1.0};
  glm::dmat4 projection{1.0};
  int width = 0;
  int height = 0;
  // Planes in world coordinates that cut the model open, at most kMaxSectionPlanes. A point is
  // neither visible nor painted if a x + b y + c z + d < 0 for one of the planes.
  std::vector<glm::dvec4> section{};
  // Parts of the model that are neither visible nor painted.
  PartSet hidden_parts{};
  bool operator==(const Camera&) const = default;
};

// Returns an error for a size outside 1…kMaxViewSize, a non-finite or singular matrix, a plane
// without a direction, or too many planes. `field` is the prefix of the field in the error.
Result<void> validate(const Camera& camera, const std::string& field = "camera");

bool is_orthographic(const Camera& camera);
glm::dvec3 eye_in_world(const Camera& camera);

// Returns a float matrix from model space (world minus origin) to clip space. The product is
// computed in double.
glm::mat4 clip_from_model(const Camera& camera, const glm::dvec3& origin);

// The section in model space, with unit normals. Unused planes cut nothing.
using SectionPlanes = std::array<glm::vec4, kMaxSectionPlanes>;
SectionPlanes section_in_model(const Camera& camera, const glm::dvec3& origin);

// Returns whether the eye is in the part that the section removes. A visible back face is then the
// inside of a solid. (Without perspective, the eye is infinitely distant.)
bool eye_is_cut_away(const Camera& camera);

// Returns the camera for some rows of the window, counted from the top. It shows the same content
// in these rows as the whole camera. `rows` must be positive.
Camera camera_of_rows(const Camera& camera, int top, int rows);

struct Ray {
  glm::dvec3 origin;     // on the near plane, in world coordinates
  glm::dvec3 direction;  // unit length
};
Ray ray_through_pixel(const Camera& camera, double x, double y);

// The part of a ray that the section keeps, as distances from the origin of the ray. If begin >
// end, the part is empty.
struct RaySpan {
  double begin = 0, end = 0;
};
RaySpan uncut_span(const Camera& camera, const Ray& ray);

}  // namespace strata
