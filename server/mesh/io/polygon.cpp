#include "mesh/io/polygon.h"

#include <cmath>
#include <numeric>

namespace strata::mesh {
namespace {

// Returns twice the signed area of the triangle a, b, c.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Projects the polygon along the axis in which it is thinnest. The result is counterclockwise.
std::vector<glm::dvec2> flatten(std::span<const glm::dvec3> corners) {
  glm::dvec3 area_vector(0);
  const glm::dvec3 base = corners[0];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    area_vector += glm::cross(corners[i] - base, corners[i + 1] - base);
  }
  int drop = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(area_vector[axis]) > std::abs(area_vector[drop])) drop = axis;
  }
  int u = (drop + 1) % 3, v = (drop + 2) % 3;
  if (area_vector[drop] < 0) std::swap(u, v);
  std::vector<glm::dvec2> flat(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 offset = corners[i] - base;
    flat[i] = {offset[u], offset[v]};
  }
  return flat;
}

bool is_convex(const std::vector<glm::dvec2>& flat) {
  const std::size_t n = flat.size();
  double winding = 0;  // a star also turns left everywhere, but its winding is twice as large
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec2 &a = flat[i], &b = flat[(i + 1) % n], &c = flat[(i + 2) % n];
    const double area = turn(a, b, c);
    if (!(area > 0)) return false;
    winding += std::atan2(area, glm::dot(b - a, c - b));
  }
  return winding < 2.5 * 3.14159265358979;
}

bool is_ear(const std::vector<glm::dvec2>& flat, const std::vector<std::uint32_t>& loop,
            std::size_t at) {
  const std::size_t n = loop.size();
  const glm::dvec2 a = flat[loop[(at + n - 1) % n]], b = flat[loop[at]],
                   c = flat[loop[(at + 1) % n]];
  if (!(turn(a, b, c) > 0)) return false;
  for (std::size_t k = 2; k + 1 < n; ++k) {
    const glm::dvec2 p = flat[loop[(at + k) % n]];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

void triangulate_polygon(std::span<const glm::dvec3> corners,
                         std::vector<std::uint32_t>& triangles) {
  triangles.clear();
  const std::size_t n = corners.size();
  if (n < 3) return;
  std::vector<glm::dvec2> flat;
  if (n > 3) flat = flatten(corners);
  if (n == 3 || is_convex(flat)) {
    for (std::uint32_t i = 1; i + 1 < n; ++i) triangles.insert(triangles.end(), {0u, i, i + 1});
    return;
  }
  std::vector<std::uint32_t> loop(n);
  std::iota(loop.begin(), loop.end(), 0u);
  std::size_t at = 0, tried = 0;
  while (loop.size() > 3) {
    at %= loop.size();
    // If there is no ear because the outline crosses itself or is flat, the next corner is cut off
    // anyway.
    if (tried < loop.size() && !is_ear(flat, loop, at)) {
      ++at;
      ++tried;
      continue;
    }
    const std::size_t before = (at + loop.size() - 1) % loop.size(), after = (at + 1) % loop.size();
    triangles.insert(triangles.end(), {loop[before], loop[at], loop[after]});
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(at));
    tried = 0;
  }
  triangles.insert(triangles.end(), {loop[0], loop[1], loop[2]});
}

}  // namespace strata::mesh
