#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/polygon_area.h"

namespace strata::query {

struct MapArea {
  PolygonArea area;
  double value = 0;
};

// Areas in a plane, each with a value, for lookup by position. A grid reduces thousands of areas to
// a few candidates.
class FlatMap {
 public:
  explicit FlatMap(std::vector<MapArea> areas);

  // Returns the value of the last area that contains the point, because later areas are on top.
  std::optional<double> value_at(const glm::dvec2& point) const;
  const std::vector<MapArea>& areas() const { return areas_; }

 private:
  struct Cells {
    int left, right, bottom, top;
  };
  Cells cells_of(const PolygonArea& area) const;
  int cell(double at, double low, double size) const;
  std::size_t entries() const;  // number of entries of the grid for `side_`

  std::vector<MapArea> areas_;
  glm::dvec2 low_, size_;
  int side_ = 1;
  std::vector<std::size_t> begins_;     // start of each cell in `in_cell_`, then the last end
  std::vector<std::uint32_t> in_cell_;  // indices of areas, ascending
};

}  // namespace strata::query
