#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "mesh/surface/search_tree.h"
#include "query/maps/plane_outlines.h"
#include "query/sampling/values.h"

namespace strata::query {

// The view of a model along an axis of the world, without perspective, as on a map or an elevation.
// `tree` must outlive it. Thread-safe.
class PlaneView {
 public:
  // `looks_up` is the direction of view: toward larger coordinates in the plane's depth. `low` and
  // `high` are the bounds of the model in world coordinates.
  PlaneView(const mesh::SearchTree& tree, const glm::dvec3& origin, const OutlinePlane& plane,
            bool looks_up, const glm::dvec3& low, const glm::dvec3& high);

  // Returns the first point of the surface at a place of the plane (right, up, in world
  // coordinates).
  std::optional<mesh::SearchTree::Hit> first_hit(const glm::dvec2& place) const;

 private:
  const mesh::SearchTree& tree_;
  glm::dvec3 origin_;
  OutlinePlane plane_;
  double start_;  // depth where the rays begin, outside the bounds
  glm::vec3 direction_{0};
};

// A grid of cells in the plane of a view. Row 0 is at the top (the largest `up`).
struct PlaneGrid {
  glm::dvec2 low{0}, high{0};  // outer edges, in world coordinates (right, up)
  int width = 0, height = 0;   // in cells

  glm::dvec2 cell() const { return (high - low) / glm::dvec2(width, height); }
  glm::dvec2 center_of(int column, int row) const {
    return {low.x + (column + 0.5) * cell().x, high.y - (row + 0.5) * cell().y};
  }
};

// The values of a layer at the cells of a grid, row by row.
struct PlaneRaster {
  int width = 0, height = 0;
  ValueType type = ValueType::u8;
  std::vector<std::uint32_t> bits;  // bits of the values, which have type `type`
  std::vector<std::uint8_t> valid;  // 0 without a surface or without paint
};

// Returns a raster for each layer: the value at the center of each cell. Cells for whose center
// `is_inside` returns false are empty; it is called from several threads. Counts steps of
// the current question: for each cell, one and one for each layer.
std::vector<PlaneRaster> resample(const PlaneView& view, std::span<const LayerView> layers,
                                  const PlaneGrid& grid,
                                  const std::function<bool(const glm::dvec2&)>& is_inside = {});

}  // namespace strata::query
