#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

// Areas in a plane and what is computed with them, by GEOS. Nothing of its headers is seen outside.
namespace strata::query {

// A ring's corners, without a repeated last one. `z` is carried along, and interpolated where lines
// cross.
using FlatRing = std::vector<glm::dvec3>;
double ring_area(const FlatRing& ring);  // negative: clockwise

struct FlatPolygon {
  std::vector<FlatRing> rings;  // the outer one first
};

// Polygons that may have holes and do not overlap, always valid as OGC simple features have it.
// Move-only. Every operation stops where the current question is over (QuestionEnded), and throws
// std::runtime_error where GEOS gives up.
class FlatArea {
 public:
  FlatArea();  // empty
  // The first ring is the outer one, in any direction; where rings cross or touch, what the outer
  // one goes round without the holes.
  explicit FlatArea(const FlatPolygon& polygon);
  FlatArea(FlatArea&&) noexcept;
  FlatArea& operator=(FlatArea&&) noexcept;
  ~FlatArea();

  bool is_empty() const;
  double area() const;
  FlatArea cut_with(const FlatArea& other) const;
  // Closed polygons: outer rings counter-clockwise, holes clockwise.
  std::vector<FlatPolygon> polygons() const;

  // What any of them covers, with corners on a grid, which is made coarser where GEOS cannot work
  // with it.
  static FlatArea joined(std::vector<FlatArea> areas, double grid);
  // With fewer corners, none farther from the line than `distance`. No polygon and no hole goes.
  FlatArea simplified(double distance) const;

 private:
  friend class FlatAreaTree;
  struct Held;
  explicit FlatArea(std::unique_ptr<Held> held);
  std::unique_ptr<Held> held_;
};

// Finds areas by their boxes. `areas` must live as long and stay where they are.
class FlatAreaTree {
 public:
  explicit FlatAreaTree(const std::vector<FlatArea>& areas);
  ~FlatAreaTree();
  FlatAreaTree(const FlatAreaTree&) = delete;
  FlatAreaTree& operator=(const FlatAreaTree&) = delete;

  // Those whose boxes meet the box of `area`.
  void find(const FlatArea& area, const std::function<void(const FlatArea&)>& visit) const;

 private:
  struct Held;
  std::unique_ptr<Held> held_;
};

}  // namespace strata::query
