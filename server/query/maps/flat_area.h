#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

// Areas in a plane and operations on them, implemented with GEOS. The headers of GEOS are not
// exposed.
namespace strata::query {

// The corners of a ring. The first corner is not repeated at the end. `z` is kept, and interpolated
// where lines cross.
using FlatRing = std::vector<glm::dvec3>;
double ring_area(const FlatRing& ring);  // negative if clockwise

struct FlatPolygon {
  std::vector<FlatRing> rings;  // the outer ring first
};

// Polygons that may have holes and do not overlap, always valid as OGC simple features. Move-only.
// Every operation throws QuestionEnded when the current question has ended, and std::runtime_error
// when GEOS fails.
class FlatArea {
 public:
  FlatArea();  // empty
  // The first ring is the outer ring. Rings may have any direction. Where rings cross or touch, the
  // area is the inside of the outer ring minus the holes.
  explicit FlatArea(const FlatPolygon& polygon);
  FlatArea(FlatArea&&) noexcept;
  FlatArea& operator=(FlatArea&&) noexcept;
  ~FlatArea();

  bool is_empty() const;
  double area() const;
  FlatArea cut_with(const FlatArea& other) const;
  // Returns closed polygons: outer rings are counterclockwise, holes are clockwise.
  std::vector<FlatPolygon> polygons() const;

  // Returns the union of the areas, with corners on a grid. The grid is made coarser if GEOS fails.
  static FlatArea joined(std::vector<FlatArea> areas, double grid);
  // Removes corners that are at most `distance` from the simplified line. Keeps all polygons and
  // holes.
  FlatArea simplified(double distance) const;

 private:
  friend class FlatAreaTree;
  struct Held;
  explicit FlatArea(std::unique_ptr<Held> held);
  std::unique_ptr<Held> held_;
};

// Finds areas by their bounding boxes. `areas` must outlive the tree and stay at their addresses.
class FlatAreaTree {
 public:
  explicit FlatAreaTree(const std::vector<FlatArea>& areas);
  ~FlatAreaTree();
  FlatAreaTree(const FlatAreaTree&) = delete;
  FlatAreaTree& operator=(const FlatAreaTree&) = delete;

  // Visits the areas whose bounding boxes intersect the bounding box of `area`.
  void find(const FlatArea& area, const std::function<void(const FlatArea&)>& visit) const;

 private:
  struct Held;
  std::unique_ptr<Held> held_;
};

}  // namespace strata::query
