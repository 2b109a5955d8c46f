#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "domain/scene/camera.h"
#include "domain/scene/model.h"

namespace strata::figure {

// A drawing to scale: which way it looks, how large it is on paper, and the parts in which it is
// rendered.

enum class Direction { top, bottom, front, back, left, right };

// The axes of the drawing in the world: unit vectors, `into` away from who looks; right × up =
// −into.
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
// Of surface with this normal (not zero), seen square; what is up in the model is up in the
// drawing, and lying surface is drawn as the plan.
Plane plane_square_to(const glm::dvec3& normal, std::string_view up);
Plane plane_of(const Camera& camera);

// Least and greatest coordinates along the axes.
struct Extent {
  glm::dvec3 min, max;
};
// Of what the section keeps; nothing where it keeps nothing.
std::optional<Extent> extent_of(std::span<const glm::dvec3> world, const Plane& plane,
                                std::span<const glm::dvec4> section);

// The largest of 1, 2, 2.5, 5, 10, 20, 25, 50 … at which `size` (model units) has room on paper; 1
// is life-size.
double fitting_scale(const glm::dvec2& size, const glm::dvec2& paper_mm, double metres_per_unit);

// What is drawn: pixels of `25.4 / dpi` mm on paper, each `scale` times as much in the world.
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

// A camera counts in hundredths of an inch, so that lines and patterns have the same width at any
// resolution.
constexpr int kCameraDpi = 100;

// A camera over a part of the drawing and the pixels that it fills: of those the ones beyond the
// drawing are left out. The camera sees `margin` more pixels on each side, which are left out, too:
// a symbol that reaches into the part is drawn by what hides its place.
struct Part {
  Camera camera;
  // pixels without the margin; origin at the drawing's top left
  int x = 0, y = 0, width = 0, height = 0;
  int margin = 0;  // even
};
// Squares of whole inches of about `side` pixels, so that all have the same pixels to the inch; row
// by row.
std::vector<Part> parts_of(const Drawing& drawing, int side = 2048);

// The whole, for what is asked of places on it; its pixels are `kCameraDpi` an inch or fewer.
Camera camera_of(const Drawing& drawing);

}  // namespace strata::figure
