#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace strata::mesh {

// The update of fast marching (Kimmel and Sethian, "Computing geodesic paths on manifolds", 1998):
// the distance of a corner C of a flat triangle ABC from the distances of A and B.

constexpr double kNoFront = std::numeric_limits<double>::infinity();

struct FrontTriangle {
  double ca = 0, cb = 0, ab = 0;  // sides; ab > 0
};

// A path to C that crosses the side AB.
struct Front {
  double distance = kNoFront;  // of C; kNoFront: no straight path to C crosses AB
  bool from_a = true;          // the path crosses AB nearer to A than to B
};

// The distance of C is refused if no straight path crosses AB, or if it is less than both distances
// that it comes from. In an obtuse triangle, the front may reach C before the farther of A and B.
// Corners cannot lower each other forever: no distance falls below 0, and BlockFront stores only
// distances that are smaller by a share of a side.
inline Front checked_front(const FrontTriangle& t, double distance_a, double distance_b,
                           double distance, double crossing) {
  if (!(crossing >= 0 && crossing <= t.ab)) return {};
  if (distance < std::min(distance_a, distance_b)) return {};
  return {distance, 2 * crossing < t.ab};
}

// A is the origin, B is on the x axis, and C is above it.
struct FrontApex {
  double x, y;
  explicit FrontApex(const FrontTriangle& t)
      : x((t.ca * t.ca + t.ab * t.ab - t.cb * t.cb) / (2 * t.ab)),
        y(std::sqrt(std::max(0.0, t.ca * t.ca - x * x))) {}
};

// The front around one point. The point is unfolded into the plane of the triangle, so the distance
// is exact on surfaces that unfold into a plane (Novotni and Klein, "Computing geodesic distances
// on triangular meshes", 2002).
inline Front circular_front(const FrontTriangle& t, double distance_a, double distance_b) {
  const double slope = (distance_b - distance_a) / t.ab;
  if (!(std::abs(slope) < 1)) return {};
  const FrontApex c(t);
  const double x = (t.ab - slope * (distance_a + distance_b)) / 2;
  const double y = std::sqrt(std::max(0.0, distance_a * distance_a - x * x));  // below AB
  if (!(y + c.y > 0)) return {};
  return checked_front(t, distance_a, distance_b,
                       std::sqrt((c.x - x) * (c.x - x) + (c.y + y) * (c.y + y)),
                       x + (c.x - x) * y / (y + c.y));
}

// The front of several sources, as a straight line.
inline Front planar_front(const FrontTriangle& t, double distance_a, double distance_b) {
  const double slope = (distance_b - distance_a) / t.ab;
  if (!(std::abs(slope) < 1)) return {};
  const FrontApex c(t);
  const double rise = std::sqrt(1 - slope * slope);
  return checked_front(t, distance_a, distance_b, distance_a + c.x * slope + c.y * rise,
                       c.x - c.y * slope / rise);
}

}  // namespace strata::mesh
