#include "domain/scene/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

namespace strata {
namespace {

bool is_finite(const glm::dmat4& m) {
  const double* p = glm::value_ptr(m);
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(p[i])) return false;
  return true;
}

constexpr double kMinNormalLength = 1e-100;

// Also tests the inverse, because the determinant alone is not reliable in small or large units.
bool is_invertible(const glm::dmat4& m) {
  const double det = glm::determinant(m);
  if (!std::isfinite(det) || det == 0) return false;
  return is_finite(glm::inverse(m));
}

}  // namespace

Result<void> validate(const Camera& camera, const std::string& field) {
  auto size = [&](int value, const char* side) -> Result<void> {
    if (value < 1 || value > kMaxViewSize)
      return fail(ErrorCode::invalid, "Size out of range",
                  "Each side of the window of a camera must be 1 to " +
                      std::to_string(kMaxViewSize) + " pixels long.",
                  field + "." + side);
    return {};
  };
  STRATA_TRY(size(camera.width, "width"));
  STRATA_TRY(size(camera.height, "height"));
  auto matrix = [&](const glm::dmat4& m, const char* name) -> Result<void> {
    if (!is_finite(m))
      return fail(ErrorCode::invalid, "Matrix not finite",
                  "Every element of the matrix must be a finite number.", field + "." + name);
    if (!is_invertible(m))
      return fail(
          ErrorCode::invalid, "Matrix has no inverse",
          "The matrix has no inverse, so the camera cannot show anything. Send an invertible "
          "matrix.",
          field + "." + name);
    return {};
  };
  STRATA_TRY(matrix(camera.view, "view"));
  STRATA_TRY(matrix(camera.projection, "projection"));
  if (camera.section.size() > kMaxSectionPlanes)
    return fail(ErrorCode::invalid, "Too many planes",
                "A section can have at most " + std::to_string(kMaxSectionPlanes) + " planes.",
                field + ".section");
  for (std::size_t i = 0; i < camera.section.size(); ++i) {
    const glm::dvec4& plane = camera.section[i];
    const double length = glm::length(glm::dvec3(plane));
    if (!std::isfinite(length) || !std::isfinite(plane.w) || !(length > kMinNormalLength))
      return fail(ErrorCode::invalid, "Plane without a direction",
                  "A plane must be [a, b, c, d] with finite numbers. At least one of a, b, c "
                  "must not be 0.",
                  field + ".section[" + std::to_string(i) + "]");
  }
  return {};
}

bool is_orthographic(const Camera& camera) {
  const auto& p = camera.projection;
  return p[0][3] == 0 && p[1][3] == 0 && p[2][3] == 0;
}

glm::dvec3 eye_in_world(const Camera& camera) { return glm::dvec3(glm::inverse(camera.view)[3]); }

glm::mat4 clip_from_model(const Camera& camera, const glm::dvec3& origin) {
  return glm::mat4(camera.projection * camera.view * glm::translate(glm::dmat4(1.0), origin));
}

Camera camera_of_rows(const Camera& camera, int top, int rows) {
  Camera part = camera;
  part.height = rows;
  const double share = static_cast<double>(rows) / camera.height;
  const double middle = 1 - (2.0 * top + rows) / camera.height;
  for (glm::length_t column = 0; column < 4; ++column)
    part.projection[column][1] =
        (camera.projection[column][1] - middle * camera.projection[column][3]) / share;
  return part;
}

SectionPlanes section_in_model(const Camera& camera, const glm::dvec3& origin) {
  SectionPlanes planes;
  planes.fill(glm::vec4(0, 0, 0, 1));
  for (std::size_t i = 0; i < camera.section.size(); ++i) {
    const glm::dvec3 normal(camera.section[i]);
    const double length = glm::length(normal);
    planes[i] =
        glm::vec4(glm::dvec4(normal, camera.section[i].w + glm::dot(normal, origin)) / length);
  }
  return planes;
}

bool eye_is_cut_away(const Camera& camera) {
  const glm::dvec4 eye = is_orthographic(camera)
                             ? glm::inverse(camera.view) * glm::dvec4(0, 0, 1, 0)
                             : glm::dvec4(eye_in_world(camera), 1);
  return std::ranges::any_of(camera.section,
                             [&](const glm::dvec4& plane) { return glm::dot(plane, eye) < 0; });
}

RaySpan uncut_span(const Camera& camera, const Ray& ray) {
  RaySpan span{0, std::numeric_limits<double>::infinity()};
  for (const glm::dvec4& plane : camera.section) {
    const double at_origin = glm::dot(plane, glm::dvec4(ray.origin, 1));
    const double slope = glm::dot(glm::dvec3(plane), ray.direction);
    if (slope > 0)
      span.begin = std::max(span.begin, -at_origin / slope);
    else if (slope < 0)
      span.end = std::min(span.end, -at_origin / slope);
    else if (at_origin < 0)
      span.end = -1;
  }
  return span;
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
