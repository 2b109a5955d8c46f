#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "domain/scene/camera.h"
#include "domain/scene/model.h"

namespace strata::figure {

// A drawing to scale: its direction, its size on paper, and the parts in which it is rendered.

enum class Direction { top, bottom, front, back, left, right };

// The axes of the drawing in the world, as unit vectors; `into` points away from the viewer; right
// × up = −into.
struct Plane {
  glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, into{0, 0, -1};
  glm::dvec3 of(const glm::dvec3& world) const {
    return {glm::dot(right, world), glm::dot(up, world), glm::dot(into, world)};
  }
  glm::dvec3 in_world(const glm::dvec3& drawn) const {
    return drawn.x * right + drawn.y * up + drawn.z * into;
  }
};
// `up`: of kUpDirections. The front of a model with z up is seen along +y.
Plane plane_from(Direction direction, std::string_view up);
// Returns the plane perpendicular to a normal (not zero); the model's up is the drawing's up, and a
// horizontal surface is drawn as the plan.
Plane plane_square_to(const glm::dvec3& normal, std::string_view up);
Plane plane_of(const Camera& camera);

// Least and greatest coordinates along the axes.
struct Extent {
  glm::dvec3 min, max;
};
// Returns the extent of the points that the section keeps; nothing if it keeps none.
std::optional<Extent> extent_of(std::span<const glm::dvec3> world, const Plane& plane,
                                std::span<const glm::dvec4> section);

// Returns the scale from 1, 2, 2.5, 5, 10, 20, 25, 50 … at which `size` (model units) fits on the
// paper; 1 is life-size.
double fitting_scale(const glm::dvec2& size, const glm::dvec2& paper_mm, double metres_per_unit);

// A drawing: pixels of `25.4 / dpi` mm on paper, each `scale` times as much in the world.
struct Drawing {
  Plane plane;
  glm::dvec2 center{0};      // along right and up
  double near = 0, far = 1;  // along into
  double scale = 1;
  double metres_per_unit = 1;
  int dpi = 300;
  int width = 0, height = 0;  // pixels
  std::vector<glm::dvec4> section{};

  double units_per_mm() const { return scale / 1000 / metres_per_unit; }
};

// A camera's pixels are hundredths of an inch, so that lines and patterns have the same width at
// any resolution.
constexpr int kCameraDpi = 100;

// A camera over a part of the drawing, and the part's pixels; those outside the drawing are not
// used. The camera also renders `margin` more pixels on each side, which are not used either: thus
// a symbol that reaches into the part is tested against the surface at its position.
struct Part {
  Camera camera;
  // pixels without the margin; origin at the drawing's top left
  int x = 0, y = 0, width = 0, height = 0;
  int margin = 0;  // even
};
// Returns squares of whole inches of about `side` pixels, so that all have the same pixels per
// inch; row by row.
std::vector<Part> parts_of(const Drawing& drawing, int side = 2048);

// Returns a camera of the whole drawing, for picks, with at most `kCameraDpi` pixels per inch.
Camera camera_of(const Drawing& drawing);

}  // namespace strata::figure
