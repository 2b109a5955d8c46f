#include "figure/drawing.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numeric>

#include "domain/scene/up.h"
#include "figure/paper.h"

namespace strata::figure {
namespace {

// The largest distance of a symbol's pixels from its position, in pixels of the camera's window.
constexpr int kSymbolReach_px = 8;

// Returns the axes of the front view, which are the same in the web client.
Plane front_of(std::string_view up) {
  const UpFrame frame = up_frame(up);
  return {frame.right, frame.up, frame.into};
}

// Returns a camera of width × height pixels over a part of the drawing.
Camera camera_over(const Drawing& drawing, const glm::dvec2& corner_mm, const glm::dvec2& size_mm,
                   int width, int height) {
  const Plane& plane = drawing.plane;
  const double unit = drawing.units_per_mm();
  const glm::dvec2 drawing_mm =
      glm::dvec2(drawing.width, drawing.height) * (kInch_mm / drawing.dpi);
  // Relative to the drawing's center.
  const double left = (corner_mm.x - drawing_mm.x / 2) * unit,
               top = (drawing_mm.y / 2 - corner_mm.y) * unit;
  const glm::dvec3 eye = plane.in_world({drawing.center, drawing.near});
  Camera camera;
  camera.view = glm::transpose(glm::dmat4(glm::dvec4(plane.right, -glm::dot(plane.right, eye)),
                                          glm::dvec4(plane.up, -glm::dot(plane.up, eye)),
                                          glm::dvec4(-plane.into, glm::dot(plane.into, eye)),
                                          glm::dvec4(0, 0, 0, 1)));
  camera.projection = glm::ortho(left, left + size_mm.x * unit, top - size_mm.y * unit, top, 0.0,
                                 drawing.far - drawing.near);
  camera.width = width;
  camera.height = height;
  camera.section = drawing.section;
  camera.hidden_parts = drawing.hidden_parts;
  return camera;
}

}  // namespace

Plane plane_from(Direction direction, std::string_view up) {
  const Plane front = front_of(up);
  switch (direction) {
    case Direction::front: return front;
    case Direction::back: return {-front.right, front.up, -front.into};
    case Direction::right: return {front.into, front.up, -front.right};
    case Direction::left: return {-front.into, front.up, front.right};
    case Direction::top: return {front.right, front.into, -front.up};
    case Direction::bottom: return {front.right, -front.into, front.up};
  }
  return front;
}

Plane plane_square_to(const glm::dvec3& normal, std::string_view up) {
  const Plane front = front_of(up);
  const glm::dvec3 into = -glm::normalize(normal);
  const double along = glm::dot(into, front.up);
  // A horizontal surface has no upward direction, so the drawing is a plan or a corresponding
  // view from below.
  constexpr double kLying = 0.999;
  const glm::dvec3 preferred_up = std::abs(along) < kLying ? front.up
                                  : along < 0              ? front.into
                                                           : -front.into;
  const glm::dvec3 right = glm::normalize(glm::cross(into, preferred_up));
  return {right, glm::cross(right, into), into};
}

Plane plane_of(const Camera& camera) {
  const glm::dmat3 axes = glm::transpose(glm::dmat3(camera.view));
  const glm::dvec3 into = -glm::normalize(axes[2]);
  const glm::dvec3 right = glm::normalize(axes[0] - glm::dot(axes[0], into) * into);
  return {right, glm::cross(right, into), into};
}

std::optional<Extent> extent_of(std::span<const glm::dvec3> world, const Plane& plane,
                                std::span<const glm::dvec4> section) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Extent extent{glm::dvec3(kFar), glm::dvec3(-kFar)};
  for (const glm::dvec3& point : world) {
    if (std::ranges::any_of(section, [&](const glm::dvec4& cut) {
          return glm::dot(cut, glm::dvec4(point, 1)) < 0;
        }))
      continue;
    const glm::dvec3 drawn = plane.of(point);
    extent.min = glm::min(extent.min, drawn);
    extent.max = glm::max(extent.max, drawn);
  }
  if (extent.min.x > extent.max.x) return std::nullopt;
  return extent;
}

std::span<const double> round_scales() {
  static const std::vector<double> kScales = [] {
    std::vector<double> scales;
    for (double decade = 1; decade < 1e6; decade *= 10)
      for (const double step : {1.0, 2.0, 2.5, 5.0}) scales.push_back(step * decade);
    scales.push_back(1e6);
    return scales;
  }();
  return kScales;
}

double fitting_scale(const glm::dvec2& size, const glm::dvec2& paper_mm, double metres_per_unit) {
  const glm::dvec2 life_mm = size * (metres_per_unit * 1000);
  const double needed = std::max(life_mm.x / paper_mm.x, life_mm.y / paper_mm.y);
  for (const double scale : round_scales())
    if (scale >= needed) return scale;
  return round_scales().back();
}

std::vector<Part> parts_of(const Drawing& drawing, int side) {
  const int inches = std::max(1, side / drawing.dpi), step = inches * drawing.dpi;
  // The margin is a whole number of pixels of the drawing and also of the camera, so the pixels
  // of all parts match.
  const int common = std::gcd(drawing.dpi, kCameraDpi);
  const int unit_px = drawing.dpi / common * 2, unit_camera = kCameraDpi / common * 2;
  const int units = (kSymbolReach_px + unit_camera - 1) / unit_camera;
  const int margin = units * unit_px, size = inches * kCameraDpi + 2 * units * unit_camera;
  const double pixel_mm = kInch_mm / drawing.dpi;
  std::vector<Part> parts;
  for (int y = 0; y < drawing.height; y += step)
    for (int x = 0; x < drawing.width; x += step)
      parts.push_back({camera_over(drawing, glm::dvec2(x - margin, y - margin) * pixel_mm,
                                   glm::dvec2(size * (kInch_mm / kCameraDpi)), size, size),
                       x, y, step, step, margin});
  return parts;
}

Camera camera_over(const Drawing& drawing, const glm::dvec2& corner_mm, const glm::dvec2& size_mm) {
  const auto pixels = [](double mm) {
    return std::clamp(static_cast<int>(mm / kInch_mm * kCameraDpi), 1, kMaxViewSize);
  };
  return camera_over(drawing, corner_mm, size_mm, pixels(size_mm.x), pixels(size_mm.y));
}

Camera camera_of(const Drawing& drawing) {
  return camera_over(drawing, {0, 0},
                     glm::dvec2(drawing.width, drawing.height) * (kInch_mm / drawing.dpi));
}

}  // namespace strata::figure
