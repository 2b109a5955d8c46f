#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/error.h"
#include "mesh/texels/surface_map.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

inline constexpr std::uint32_t kNoCell = 0xffffffffu;

// A coarse level of a surface: cells of connected texels, whose centers are about evenly spaced
// along the surface. A cell crosses the seams of the atlas. It does not reach the other side of a
// thin wall, except around its rim by less than the spacing.
//
// The cells are the Voronoi cells of their centers. For such cells, differences between centers
// times `conductance` are the fluxes of the finite volume method.
struct SurfaceCells {
  // The common border of a cell with another cell.
  struct Side {
    std::uint32_t other;
    double conductance;  // length of the border / distance of the centers
    // The gradient of a quantity at the center of the cell is the sum of this times the difference
    // to the other cell.
    glm::dvec3 gradient;
  };
  double spacing = 0;                   // the smallest distance of centers, in model units
  std::vector<std::uint32_t> of_texel;  // 64 per slot of the map; kNoCell outside the cells
  std::vector<glm::dvec3> centers;      // of texels, in model space
  std::vector<double> areas;            // in model units²
  std::vector<std::size_t> first_side;  // of each cell, and the end
  std::vector<Side> sides;              // of each cell in ascending order
  std::vector<std::size_t> first_near;  // of each cell, and the end
  // The cells whose weight can be above 0 in a cell: itself, its neighbors and theirs.
  std::vector<std::uint32_t> near;

  std::size_t count() const { return centers.size(); }
  std::span<const Side> sides_of(std::uint32_t cell) const {
    return std::span(sides).subspan(first_side[cell], first_side[cell + 1] - first_side[cell]);
  }
  std::span<const std::uint32_t> near_cells(std::uint32_t cell) const {
    return std::span(near).subspan(first_near[cell], first_near[cell + 1] - first_near[cell]);
  }

  // Calls visit(cell, weight, offset) for the cells around a position in cell `own`. A quantity
  // there is the sum of weight · (quantity at the center + gradient · offset). The weights add up
  // to 1 and fall smoothly to 0 where a cell is no longer near, so that no border of a cell is
  // visible. Quantities that are linear on a flat surface are exact.
  template <class Visit>
  void for_each_weight(std::uint32_t own, glm::dvec3 at, Visit&& visit) const {
    const double reach = kReach * spacing;
    const auto weight_of = [&](std::uint32_t cell) {
      const glm::dvec3 offset = at - centers[cell];
      const double rest = 1 - glm::dot(offset, offset) / (reach * reach);
      return rest > 0 ? rest * rest : 0;
    };
    double sum = 0;
    for (const std::uint32_t cell : near_cells(own)) sum += weight_of(cell);
    for (const std::uint32_t cell : near_cells(own))
      if (const double weight = weight_of(cell); weight > 0)
        visit(cell, weight / sum, at - centers[cell]);
  }

  // In spacings. A position is at most one spacing from the center of its cell, so the weight of
  // this cell is not 0.
  static constexpr double kReach = 1.5;
};

// Returns the cells of all connected surface that contains one of the texels `starts`. `spacing`
// (model units) is at least two texels. Returns nothing if there would be more than `max_cells`.
// Needs 16 bytes of memory per texel of the map and about 600 bytes per cell. Fails when cancelled.
//
// The centers are chosen one after another: the next center is next to the cells that exist, and
// farther than the spacing from all centers.
Result<std::optional<SurfaceCells>> make_surface_cells(const mesh::SurfaceMap& map,
                                                       const mesh::TexelGraph& graph,
                                                       std::span<const std::uint32_t> starts,
                                                       double spacing, std::size_t max_cells,
                                                       const Progress& progress);

}  // namespace strata::query
