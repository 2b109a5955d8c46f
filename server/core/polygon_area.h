#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace strata {

// The inside of closed rings in a plane by the even-odd rule: a ring within a ring is a hole, and
// an area that a ring encloses twice is outside. A point on an edge belongs to one of its sides.
// Tests only the edges at the point's height.
class PolygonArea {
 public:
  // Each ring is closed by an edge from its last point to the first. Coordinates are finite.
  explicit PolygonArea(const std::vector<std::vector<glm::dvec2>>& rings);

  bool contains(const glm::dvec2& point) const;
  // of the bounding box of all rings; above high() without rings
  glm::dvec2 low() const { return low_; }
  glm::dvec2 high() const { return high_; }

 private:
  struct Edge {
    glm::dvec2 lower, upper;
  };
  int row_of(double y) const;

  glm::dvec2 low_, high_;
  std::vector<Edge> edges_;        // by rows; each row has the edges that cross it
  std::vector<std::size_t> rows_;  // index of each row's first edge, and the end
};

}  // namespace strata
