#include "core/camera.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace strata {
namespace {

bool is_finite(const glm::dmat4& m) {
  const double* p = glm::value_ptr(m);
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(p[i])) return false;
  return true;
}

// A determinant alone says little of a matrix in small or large units; what is needed is a usable inverse.
bool is_invertible(const glm::dmat4& m) {
  const double det = glm::determinant(m);
  if (!std::isfinite(det) || det == 0) return false;
  return is_finite(glm::inverse(m));
}

}  // namespace

Result<void> validate(const Camera& camera, const std::string& field) {
  auto size = [&](int value, const char* side) -> Result<void> {
    if (value < 1 || value > kMaxViewSize)
      return fail(422, "Size out of range",
                  "A camera's window is 1 to " + std::to_string(kMaxViewSize) + " pixels a side.", field + "." + side);
    return {};
  };
  if (auto ok = size(camera.width, "width"); !ok) return ok;
  if (auto ok = size(camera.height, "height"); !ok) return ok;
  auto matrix = [&](const glm::dmat4& m, const char* name) -> Result<void> {
    if (!is_finite(m))
      return fail(422, "Matrix not finite", "Every element must be a finite number.", field + "." + name);
    if (!is_invertible(m))
      return fail(422, "Matrix is singular", "The matrix has no inverse, so nothing can be seen with it.",
                  field + "." + name);
    return {};
  };
  if (auto ok = matrix(camera.view, "view"); !ok) return ok;
  return matrix(camera.projection, "projection");
}

bool is_orthographic(const Camera& camera) {
  const auto& p = camera.projection;
  return p[0][3] == 0 && p[1][3] == 0 && p[2][3] == 0;
}

glm::dvec3 eye_in_world(const Camera& camera) { return glm::dvec3(glm::inverse(camera.view)[3]); }

glm::mat4 clip_from_model(const Camera& camera, const glm::dvec3& origin) {
  return glm::mat4(camera.projection * camera.view * glm::translate(glm::dmat4(1.0), origin));
}

Ray ray_through_pixel(const Camera& camera, double x, double y) {
  const double ndc_x = 2 * x / camera.width - 1;
  const double ndc_y = 1 - 2 * y / camera.height;
  const glm::dmat4 world_from_clip = glm::inverse(camera.projection * camera.view);
  auto unproject = [&](double z) {
    const glm::dvec4 p = world_from_clip * glm::dvec4(ndc_x, ndc_y, z, 1);
    return glm::dvec3(p) / p.w;
  };
  const glm::dvec3 near = unproject(-1);
  return {near, glm::normalize(unproject(1) - near)};
}

}  // namespace strata
