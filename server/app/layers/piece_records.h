#pragma once

#include <optional>

#include "app/layers/cleanup.h"

namespace strata::app {

inline constexpr std::size_t kMaxPieceRecords = 10'000;

struct PieceRecords {
  LayerId into = 0;                        // the layer of records
  std::optional<std::uint32_t> of_bits{};  // value of the pieces; empty: all values
  double min_area_m2 = 0;
  // Measures the pieces as lines (query/regions/center_lines.h). Texels that touch at corners are
  // then one piece.
  bool as_lines = false;
  bool in_reading_order = false;  // query/regions/reading_order.h; otherwise the largest first
  // Columns of the table for the number of the piece, its area in cm² and its perimeter in mm.
  std::optional<ColumnId> number{}, area_cm2{}, perimeter_mm{};
  // Columns for the measures of lines in mm.
  std::optional<ColumnId> length_mm{}, width_mm{}, greatest_width_mm{};
};

// Creates a record for each connected piece of a class of `layer`, the largest first or in reading
// order, and paints the keys of the records on the layer `into`. Notifies participants. If a record
// cannot be written, nothing is painted (422, `columns`). If the keys cannot be painted, or if
// other users have painted all texels of the pieces in the meantime, the records are deleted again.
// They remain if it is not certain that they are unpainted and unchanged; then the detail of the
// Error names them.
Result<CleanupResult> make_piece_records(const Services& services, room::Room& room,
                                         const Layer& layer, const PieceRecords& pieces,
                                         const CleanupEdit& edit, Progress& progress);

}  // namespace strata::app
