#include "mesh/atlas/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/atlas/flatten.h"
#include "mesh/surface/face_neighbours.h"

namespace strata::mesh {
namespace {

float turn_of(glm::vec2 a, glm::vec2 b, glm::vec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Returns the corners of the convex hull, counterclockwise.
std::vector<glm::vec2> hull_of(std::vector<glm::vec2> points) {
  const auto before = [](glm::vec2 a, glm::vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<glm::vec2> hull;
  const auto add = [&](glm::vec2 p, std::size_t min_size) {
    while (hull.size() > min_size && turn_of(hull[hull.size() - 2], hull.back(), p) <= 0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const auto p : points) add(p, 1);
  const std::size_t lower = hull.size();
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
  hull.pop_back();
  return hull;
}

// Rotates the outline so that its bounding box has the smallest area. One side of that box is on
// an edge of the convex hull.
void turn(Outline& outline) {
  const auto hull = hull_of(outline.segments);
  float least = std::numeric_limits<float>::max();
  Outline best;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const glm::vec2 edge = hull[(i + 1) % hull.size()] - hull[i];
    const float length = glm::length(edge);
    Outline turned;
    if (length > 0) turned.cosine = edge.x / length, turned.sine = -edge.y / length;
    glm::vec2 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const auto& p : hull) {
      const glm::vec2 q = turned.from_chart(p);
      low = glm::min(low, q), high = glm::max(high, q);
    }
    turned.low = low, turned.size = high - low;
    if (const float area = turned.size.x * turned.size.y; area < least) least = area, best = turned;
  }
  // The box is computed from the segments, because rounding in the hull may leave points slightly
  // outside it.
  glm::vec2 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  best.low = glm::vec2(0);
  for (auto& p : outline.segments) {
    p = best.from_chart(p);
    low = glm::min(low, p), high = glm::max(high, p);
  }
  for (auto& p : outline.segments) p -= low;
  best.low = low, best.size = high - low;
  best.segments = std::move(outline.segments);
  outline = std::move(best);
}

}  // namespace

void Outline::squeeze(glm::vec2 factors) {
  for (auto& p : segments) p *= factors;
  size *= factors, scale *= factors, low *= factors;
}

Outline make_outline_of(const Chart& chart, std::span<const glm::vec2> plane) {
  Outline outline;
  for (const auto face : chart.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      outline.segments.push_back(plane[3 * std::size_t{face} + k]);
      outline.segments.push_back(plane[3 * std::size_t{face} + (k + 1) % 3]);
    }
  turn(outline);
  return outline;
}

std::vector<Outline> make_outlines(const ChartSurface& surface, std::span<const Chart> charts,
                                   std::span<const glm::vec2> plane) {
  const auto chart_of_face = chart_of_faces(charts, surface.mesh.triangle_count());
  std::vector<Outline> outlines(charts.size());
  for (std::size_t c = 0; c < charts.size(); ++c) {
    for (const auto face : charts[c].faces)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t next = surface.neighbours[3 * std::size_t{face} + k];
        if (next != kNoTriangle && chart_of_face[next] == c) continue;
        outlines[c].segments.push_back(plane[3 * std::size_t{face} + k]);
        outlines[c].segments.push_back(plane[3 * std::size_t{face} + (k + 1) % 3]);
      }
    turn(outlines[c]);
  }
  return outlines;
}

}  // namespace strata::mesh
