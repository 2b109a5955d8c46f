#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "domain/scene/camera.h"
#include "domain/scene/model.h"

namespace strata::figure {

// A drawing to scale: its direction, its size on paper, and the parts that are rendered.

enum class Direction { top, bottom, front, back, left, right };

// The axes of the drawing in the world, as unit vectors. `into` points away from the eye, and right
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
// `up` is one of kUpDirections. The front view of a model with z up looks along +y.
Plane plane_from(Direction direction, std::string_view up);
// Returns the plane perpendicular to a normal, which must not be zero. The model's up is the
// drawing's up. A horizontal surface is drawn as in a plan.
Plane plane_square_to(const glm::dvec3& normal, std::string_view up);
Plane plane_of(const Camera& camera);

// The smallest and largest coordinates along the axes.
struct Extent {
  glm::dvec3 min, max;
};
// Returns the extent of the points that the section keeps, or nothing if it removes all points.
std::optional<Extent> extent_of(std::span<const glm::dvec3> world, const Plane& plane,
                                std::span<const glm::dvec4> section);

// The scales 1, 2, 2.5, 5, 10, 20, 25, 50 … 1 000 000, ascending. 1 is life size.
std::span<const double> round_scales();
// Returns the first round scale at which `size` (in model units) fits on the paper.
double fitting_scale(const glm::dvec2& size, const glm::dvec2& paper_mm, double metres_per_unit);

// A drawing. A pixel is `25.4 / dpi` mm on paper, and `scale` times as long in the world.
struct Drawing {
  Plane plane;
  glm::dvec2 center{0};      // coordinates along right and up
  double near = 0, far = 1;  // coordinates along into
  double scale = 1;
  double metres_per_unit = 1;
  int dpi = 300;
  int width = 0, height = 0;  // in pixels
  std::vector<glm::dvec4> section{};
  PartSet hidden_parts{};

  double units_per_mm() const { return scale / 1000 / metres_per_unit; }
};

// A camera pixel is a hundredth of an inch, so lines and patterns have the same width at any
// resolution.
constexpr int kCameraDpi = 100;

// A part of the drawing, with its camera, which also renders a margin on each side. The margin and
// pixels outside the drawing are discarded. A symbol in the margin can extend into the part. The
// margin contains the surface at the symbol's position, so the server can test if it is hidden.
struct Part {
  Camera camera;
  // In pixels from the drawing's top left, without the margin.
  int x = 0, y = 0, width = 0, height = 0;
  int margin = 0;  // in pixels, always even
};
// Returns squares of about `side` pixels, row by row. Their sides are whole inches, so all of them
// have the same pixels per inch.
std::vector<Part> parts_of(const Drawing& drawing, int side = 2048);

// Returns a camera over a part of the drawing, for picking. `corner_mm` and `size_mm` are in
// millimeters on paper, from the drawing's top left.
Camera camera_over(const Drawing& drawing, const glm::dvec2& corner_mm, const glm::dvec2& size_mm);
// Returns a camera over the whole drawing, for picking, with at most `kCameraDpi` pixels per inch.
Camera camera_of(const Drawing& drawing);

}  // namespace strata::figure
