#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "query/regions/regions.h"

namespace strata::query {

struct PieceRequest {
  std::optional<std::uint32_t> of{};  // the value; empty: all values
  double min_area = 0;                // model units²; smaller pieces are left out
  std::size_t max_pieces = 0;
  Connection connection = Connection::sides;
};

// A connected area of one value.
struct Piece {
  TexelValue value;
  std::uint64_t texels = 0;
  double area = 0;       // model units²
  double perimeter = 0;  // model units; see measure_perimeters
  glm::dvec3 center{0};  // of the area, in model space; it need not be on the surface
};

struct Pieces {
  std::vector<Piece> list;              // the largest first, then by the lowest texel
  std::vector<std::uint32_t> of_texel;  // index in `list`; kNoRegion outside the pieces
};

// Fails like find_regions, and with an `invalid` error at `min_area_cm2` for more than `max_pieces`
// pieces.
Result<Pieces> find_pieces(const SurfaceValues& values, const PieceRequest& request,
                           const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                           Progress& progress, int threads = 1);

// Puts the pieces in the order of their numbers in `order`, which contains each number once. Fails
// when cancelled.
Result<void> reorder(Pieces& pieces, const std::vector<std::uint32_t>& order,
                     const Progress& progress);

}  // namespace strata::query
