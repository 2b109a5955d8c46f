#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

// Areas in a plane and operations on them, by GEOS. Its headers are not exposed.
namespace strata::query {

// A ring's corners, without a repeated last one. `z` is kept, and interpolated where lines cross.
using FlatRing = std::vector<glm::dvec3>;
double ring_area(const FlatRing& ring);  // negative: clockwise

struct FlatPolygon {
  std::vector<FlatRing> rings;  // the outer one first
};

// Polygons that may have holes and do not overlap, always valid as OGC simple features. Move-only.
// Every operation throws QuestionEnded when the current question is over, and std::runtime_error
// when GEOS fails.
class FlatArea {
 public:
  FlatArea();  // empty
  // The first ring is the outer one, in any direction. Where rings cross or touch, the area is the
  // one enclosed by the outer ring without the holes.
  explicit FlatArea(const FlatPolygon& polygon);
  FlatArea(FlatArea&&) noexcept;
  FlatArea& operator=(FlatArea&&) noexcept;
  ~FlatArea();

  bool is_empty() const;
  double area() const;
  FlatArea cut_with(const FlatArea& other) const;
  // Closed polygons: outer rings counterclockwise, holes clockwise.
  std::vector<FlatPolygon> polygons() const;

  // The union of the areas, with corners on a grid, which is made coarser if GEOS fails.
  static FlatArea joined(std::vector<FlatArea> areas, double grid);
  // Removes corners; no removed corner is farther than `distance` from the line. Keeps all polygons
  // and holes.
  FlatArea simplified(double distance) const;

 private:
  friend class FlatAreaTree;
  struct Held;
  explicit FlatArea(std::unique_ptr<Held> held);
  std::unique_ptr<Held> held_;
};

// Finds areas by their boxes. `areas` must outlive the tree and stay at their addresses.
class FlatAreaTree {
 public:
  explicit FlatAreaTree(const std::vector<FlatArea>& areas);
  ~FlatAreaTree();
  FlatAreaTree(const FlatAreaTree&) = delete;
  FlatAreaTree& operator=(const FlatAreaTree&) = delete;

  // Visits the areas whose boxes intersect the box of `area`.
  void find(const FlatArea& area, const std::function<void(const FlatArea&)>& visit) const;

 private:
  struct Held;
  std::unique_ptr<Held> held_;
};

}  // namespace strata::query
