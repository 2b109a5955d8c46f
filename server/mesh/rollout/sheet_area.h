#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/polygon_area.h"

namespace strata::mesh {

// The points of a plane inside at least one of several polygons or under at least one of several
// strokes. A test visits only the edges and segments near the point.
class SheetArea {
 public:
  // The points at most `radius` from the path. A path of one point is a disc.
  struct Stroke {
    std::vector<glm::dvec2> path;
    double radius = 0;
  };
  // Coordinates must be finite, and paths must not be empty. Each polygon is closed, with the
  // even-odd rule (PolygonArea). Checks the current question. Takes about 1 KiB per point
  // at most.
  SheetArea(const std::vector<std::vector<glm::dvec2>>& polygons,
            const std::vector<Stroke>& strokes);

  bool contains(const glm::dvec2& point) const;
  // The bounding box. Without polygons and strokes, low() is above high().
  glm::dvec2 low() const { return low_; }
  glm::dvec2 high() const { return high_; }

 private:
  struct Segment {
    glm::dvec2 from, to;
    double radius;
    double distance(const glm::dvec2& point) const;
  };
  static constexpr std::uint32_t kSide = 64;  // cells along a side of the strokes' bounding box
  void sort_into_cells();
  bool under_stroke(const glm::dvec2& point) const;

  glm::dvec2 low_, high_;
  std::vector<PolygonArea> polygons_;
  std::vector<Segment> segments_;
  glm::dvec2 strokes_low_{0}, cell_size_{0};
  std::vector<std::uint8_t> is_covered_;           // cells that one segment covers completely
  std::vector<std::vector<std::uint32_t>> cells_;  // segments that cover a part of the cell
};

}  // namespace strata::mesh
