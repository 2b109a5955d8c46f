#pragma once

#include <cstdint>
#include <vector>

#include "core/progress.h"

namespace strata::figure {

// A grid of labels, row by row from the top left. A cell with kNoLabel has no label.
inline constexpr std::uint32_t kNoLabel = 0;
struct LabelGrid {
  int columns = 0, rows = 0;
  std::vector<std::uint32_t> labels;
};

// The faces of a grid: the pieces of equal label whose cells are connected by their sides.
inline constexpr std::uint32_t kOutside = 0;  // the face around the grid
struct LabelFaces {
  int columns = 0, rows = 0;
  std::vector<std::uint32_t> face;   // by cell
  std::vector<std::uint32_t> label;  // by face; kNoLabel for kOutside
  std::size_t dropped_faces = 0, dropped_cells = 0;

  // Returns kOutside for a cell outside the grid.
  std::uint32_t at(int x, int y) const {
    if (x < 0 || y < 0 || x >= columns || y >= rows) return kOutside;
    return face[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                static_cast<std::size_t>(x)];
  }
};

// Finds the faces. First gives pieces of fewer than `smallest` cells the label of the neighbor with
// the longest common border, the smallest pieces first. This may be kNoLabel. Pieces without a
// label are also filled. Returns the error `cancelled`.
Result<LabelFaces> label_faces(LabelGrid grid, std::size_t smallest, const Progress& progress);

}  // namespace strata::figure
