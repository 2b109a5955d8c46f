#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "mesh/texels/texel_graph.h"

namespace strata::query {

// The texels over a seam that a path of at most three steps from a texel reaches.
struct SeamReach {
  std::vector<std::uint32_t> over_seam;
  bool at_open_edge = false;
};

// Short lines through texels, which measure borders by counting their crossings (see perimeter.h
// for the method). Each line runs from a texel to a texel one or two steps away, in 8 directions
// and their opposites, also across seams of the atlas.
class BorderLines {
 public:
  BorderLines(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph);

  // Calls crosses(other) for each line that starts at `texel`, and visit(other, length) if the
  // result is true. `length` is the border length in model units that the line represents. The
  // same border is also crossed by the line from `other` to `texel`, so each of them is one half.
  // A line that leaves the surface at an open edge ends at kNoNeighbour, and has no opposite line.
  template <class Crosses, class Visit>
  void for_each_crossing(std::uint32_t texel, Crosses&& crosses, Visit&& visit) const {
    Surroundings around(*this, texel);
    for (std::size_t direction = 0; direction < walks_.size(); ++direction) {
      std::uint32_t other = walk(texel, walks_[direction]);
      if (other == mesh::kNoNeighbour) other = around.beyond_seam(direction);
      if (!crosses(other)) continue;
      if (other == mesh::kNoNeighbour && !around.is_at_open_edge()) continue;
      visit(other, around.weight(direction));
    }
  }

 private:
  static constexpr std::size_t kDirections = 8;  // plus the opposite directions
  static constexpr std::array<std::array<int, 2>, kDirections> kDirection{
      {{1, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 1}, {-1, 2}, {-1, 1}, {-2, 1}}};

  // The paths along the axes to the texel at an offset. Paths near the straight line come first.
  struct Walk {
    int steps = 0;
    std::array<std::array<mesh::Way, 3>, 3> orders{};
    int order_count = 0;
  };
  static Walk walk_along(int dx, int dy);

  // Returns kNoNeighbour if the island ends before the end of the walk.
  std::uint32_t walk(std::uint32_t texel, const Walk& walk) const {
    for (int order = 0; order < walk.order_count; ++order) {
      std::uint32_t at = texel;
      for (int i = 0; i < walk.steps && at != mesh::kNoNeighbour; ++i)
        at = step(at, walk.orders[static_cast<std::size_t>(order)][static_cast<std::size_t>(i)]);
      if (at != mesh::kNoNeighbour) return at;
    }
    return mesh::kNoNeighbour;
  }
  std::uint32_t step(std::uint32_t texel, mesh::Way way) const {
    return mesh::neighbour(map_, graph_, texel, way);
  }
  glm::dvec3 place(std::uint32_t texel) const;

  // The properties of a texel that are computed only near a border.
  class Surroundings {
   public:
    Surroundings(const BorderLines& lines, std::uint32_t texel) : lines_(lines), texel_(texel) {}

    // Returns the border length that a pair of texels in this direction represents.
    double weight(std::size_t direction);
    bool is_at_open_edge() { return reach().at_open_edge; }
    // Returns the texel across a seam in this direction, or kNoNeighbour if the seam has no other
    // side.
    std::uint32_t beyond_seam(std::size_t direction);

   private:
    const SeamReach& reach();
    bool are_beside(std::uint32_t a, std::uint32_t b) const;
    std::array<double, kDirections> weigh();
    // Returns the sides of a texel as vectors on the surface.
    const std::pair<glm::dvec3, glm::dvec3>& sides();

    const BorderLines& lines_;
    const std::uint32_t texel_;
    std::optional<std::array<double, kDirections>> weights_{};
    std::optional<SeamReach> reach_{};
    std::optional<std::pair<glm::dvec3, glm::dvec3>> sides_{};
  };

  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  std::array<Walk, 2 * kDirections> walks_{};
};

}  // namespace strata::query
