#include "bench/standing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace strata::bench {
namespace {

struct Known {
  const char* beginning;  // beginning of the title
  Standing standing;
};
// Chosen by eye on the contact sheet.
const std::array kKnown{
    Known{"amazon", {"y", 0}},
    Known{"bust_manwreath", {"y", -50}},
    Known{"dragon_stanford", {"y", 0}},
    Known{"gargoyle", {"y", 0}},
    Known{"lithic_flake1", {"z", 75}},
    Known{"mask_bali/", {"y", 0}},
    Known{"statue_nefertiti", {"y", 0}},
    Known{"textured10m", {"y", 0}},
    Known{"thai", {"y", 0}},
    Known{"vessel_jug", {"z", 0}},  // before the preset `vessel`, because the first match is used
    Known{"vessel", {"y", 0}},
};

constexpr double kFieldOfViewDegrees = 30;
constexpr double kMargin = 0.06;  // share of the image, on each side

// The directions as an observer in front of the model sees them: right, towards the observer, and
// up.
struct Axes {
  glm::dvec3 right, front, up;
};

Axes axes_of(const Standing& standing) {
  Axes axes = standing.up == "x"   ? Axes{{0, 1, 0}, {0, 0, -1}, {1, 0, 0}}
              : standing.up == "y" ? Axes{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}
                                   : Axes{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  const double angle = glm::radians(standing.turned_degrees);
  const glm::dvec3 right = axes.right, front = axes.front;
  axes.right = std::cos(angle) * right - std::sin(angle) * front;
  axes.front = std::cos(angle) * front + std::sin(angle) * right;
  return axes;
}

}  // namespace

Standing standing_of(const std::string& title, const std::string& up) {
  Standing standing;
  for (const Known& known : kKnown)
    if (title.starts_with(known.beginning)) {
      standing = known.standing;
      break;
    }
  if (!up.empty()) standing.up = up;
  return standing;
}

Camera fitted_camera(const mesh::Geometry& geometry, const Standing& standing, glm::dvec3 from,
                     int side) {
  const Axes axes = axes_of(standing);
  const glm::dvec3 back =
      glm::normalize(from.x * axes.right + from.y * axes.front + from.z * axes.up);
  const glm::dvec3 right = glm::normalize(glm::cross(axes.up, back)), up = glm::cross(back, right);
  const double field = glm::radians(kFieldOfViewDegrees),
               slope = std::tan(field / 2) * (1 - 2 * kMargin);
  // In the axes of the view, a camera at (cx, cy, d) shows a vertex (x, y, z) if |x − cx| ≤ slope
  // (d − z), and the same for y. These are four planes in cx, cy and d. Only the farthest planes of
  // all vertices are used.
  constexpr double kMin = std::numeric_limits<double>::lowest();
  double to_right = kMin, to_left = kMin, to_top = kMin, to_bottom = kMin, nearest = kMin,
         farthest = -kMin;
  for (const auto& vertex : geometry.vertices) {
    const glm::dvec3 p(vertex.position);
    const double x = glm::dot(p, right), y = glm::dot(p, up), z = glm::dot(p, back);
    to_right = std::max(to_right, x + slope * z);
    to_left = std::max(to_left, -x + slope * z);
    to_top = std::max(to_top, y + slope * z);
    to_bottom = std::max(to_bottom, -y + slope * z);
    nearest = std::max(nearest, z);
    farthest = std::min(farthest, z);
  }
  const double distance = std::max(to_right + to_left, to_top + to_bottom) / (2 * slope);
  const glm::dvec3 eye = geometry.origin + (to_right - to_left) / 2 * right +
                         (to_top - to_bottom) / 2 * up + distance * back;
  const double spare = 0.01 * (distance - farthest);
  return {glm::lookAt(eye, eye - back, up),
          glm::perspective(field, 1.0, std::max(distance - nearest - spare, spare / 10),
                           distance - farthest + spare),
          side, side};
}

}  // namespace strata::bench
