#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace strata {

// The inside of closed rings in a plane by the even-odd rule: a ring within a ring is a hole, and
// what a ring goes round twice is outside. A point on an edge belongs to one of its sides. Asks
// only the edges at a point's height.
class PolygonArea {
 public:
  // Rings are closed by joining their last point with the first. Coordinates are finite.
  explicit PolygonArea(const std::vector<std::vector<glm::dvec2>>& rings);

  bool contains(const glm::dvec2& point) const;
  // of the box around all rings; above high() where there are none
  glm::dvec2 low() const { return low_; }
  glm::dvec2 high() const { return high_; }

 private:
  struct Edge {
    glm::dvec2 lower, upper;
  };
  int row_of(double y) const;

  glm::dvec2 low_, high_;
  std::vector<Edge> edges_;        // by rows: an edge stands in each row that it reaches into
  std::vector<std::size_t> rows_;  // first edge of each, and the end
};

}  // namespace strata
