#pragma once

#include "app/figures/sheet_view.h"
#include "figure/layer_areas.h"

namespace strata::app {

// The layers of a figure as vectors.

// The outlines are those of a grid of cells of this size, or of the tolerance if it is smaller. A
// larger drawing has larger cells, so that the grid has at most kMaxOutlineCells.
inline constexpr double kOutlineCell_mm = 25.4 / 300;
inline constexpr double kMaxOutlineCells = 16e6;
// Pieces are left out if they are smaller than a square whose sides are this multiple of the
// tolerance.
inline constexpr double kSmallestPiece = 2;

// Returns the indices of the layers whose areas become outlines in PDF and SVG, in ascending order.
// These are layers of records, and layers of whole numbers whose palette has classes, that are
// blended normally and have no paint that waits for review. All layers above them must also become
// outlines, because the picture is below the outlines. In DXF files, all layers with classes become
// outlines.
std::vector<std::size_t> outlined_layers(const FigureRequest& request);

// Returns the visible areas of these layers, in their order, and then the lines and points of all
// layers of records. Areas below others are complete. In PDF and SVG, areas
// continue slightly beyond the drawing, so the drawing must clip them. Returns 422 for areas with
// too many small pieces, 503 if too many figures are being created, and `cancelled`. Blocks.
struct FigureVectors {
  std::vector<figure::LayerVectors> areas, marks;
  std::shared_ptr<const void> held;  // their part of the budget
};
Result<FigureVectors> figure_vectors(store::Store& store, ByteBudget& budget,
                                     const FigureRequest& request, const figure::Drawing& drawing,
                                     const figure::Box& area, const Stage& stage,
                                     Progress& progress);

}  // namespace strata::app
