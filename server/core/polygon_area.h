#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace strata {

// The inside of closed rings in a plane, by the even-odd rule. A ring within a ring is a hole, and
// an area that one ring encloses twice is outside. A point on an edge is either inside or outside.
// A test visits only the edges at the height of the point. Takes about 1 KiB per point at most.
class PolygonArea {
 public:
  // Each ring is closed by an edge from its last point to its first. Coordinates must be finite.
  explicit PolygonArea(const std::vector<std::vector<glm::dvec2>>& rings);

  bool contains(const glm::dvec2& point) const;
  // The bounding box of all rings. Without rings, low() is above high().
  glm::dvec2 low() const { return low_; }
  glm::dvec2 high() const { return high_; }

 private:
  struct Edge {
    glm::dvec2 lower, upper;
  };
  int row_of(double y) const;

  glm::dvec2 low_, high_;
  std::vector<Edge> edges_;        // by row; each row lists the edges that cross it
  std::vector<std::size_t> rows_;  // index of the first edge of each row, then the end
};

}  // namespace strata
