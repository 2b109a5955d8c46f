#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "figure/outlines/label_faces.h"

namespace strata::figure {

// The borders between faces of a grid, as a planar graph. Coordinates are cells from the top left,
// y down. A border is the line through the middles of the sides of its cells, so it is at most
// 0.36 cells away from these sides. It ends at nodes: the corners of cells where more than two
// borders meet, and the corners of the grid.

inline constexpr std::uint32_t kNoNode = 0xffffffff;
struct BorderArc {
  // In half cells. The first and the last point are the nodes. A ring without nodes is closed and
  // does not repeat its first point.
  std::vector<glm::ivec2> chain;
  // The faces on both sides, for somebody who walks along the chain on the page.
  std::uint32_t left = kOutside, right = kOutside;
  std::uint32_t from = kNoNode, to = kNoNode;
  int first_direction = 0, last_direction = 0;  // 0: right, 1: down, 2: left, 3: up

  bool is_ring() const { return from == kNoNode; }
};

// A direction along an arc: twice its number, plus 1 if it is walked backward.
using HalfArc = std::uint32_t;
inline constexpr HalfArc kNoHalfArc = 0xffffffff;
struct BorderNode {
  glm::ivec2 at;                                                                   // in cells
  std::array<HalfArc, 4> leaving{kNoHalfArc, kNoHalfArc, kNoHalfArc, kNoHalfArc};  // by direction
};

struct BorderGraph {
  std::vector<BorderArc> arcs;
  std::vector<BorderNode> nodes;

  std::uint32_t face_left_of(HalfArc half) const {
    return half % 2 == 0 ? arcs[half / 2].left : arcs[half / 2].right;
  }
  std::uint32_t start_of(HalfArc half) const {
    return half % 2 == 0 ? arcs[half / 2].from : arcs[half / 2].to;
  }
  // Returns the closed walks around the faces, each with its face on the left. Together they
  // contain both directions of each arc once.
  std::vector<std::vector<HalfArc>> walks() const;

 private:
  HalfArc next(HalfArc half) const;  // for an arc with nodes
};

// Traces the borders of all faces, with the frame of the grid. Errors: `cancelled`, and `invalid`
// if more than `most_sides` sides of cells are borders.
Result<BorderGraph> border_arcs(const LabelFaces& faces, std::size_t most_sides,
                                const Progress& progress);

}  // namespace strata::figure
