#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "query/conditions/texel_selection.h"
#include "query/regions/regions.h"

namespace strata::query {

// A connected area of one value that overlaps no painted area of another state.
struct LonePiece {
  TexelValue value;
  double area = 0;  // model units²
  glm::vec3 at{0};  // the texel of the piece that is nearest to its center, in model space
};

struct LonePieces {
  std::vector<LonePiece> list;  // the largest first, then by the lowest texel
  std::uint64_t count = 0;      // of all pieces, also of those that are not in the list
  double area = 0;              // of all pieces, model units²
};

struct LonePiecesRequest {
  double min_area = 0;  // model units²; smaller pieces are left out
  std::size_t max_listed = 0;
};

// Finds the pieces of a layer that overlap nothing in another state of the surface. `known` are the
// texels that this state covers, and `painted` are those that are painted in it. A piece counts
// only if more than half of its area is known. Fails like find_regions.
Result<LonePieces> find_lone_pieces(const SurfaceValues& values, const TexelSelection& known,
                                    const TexelSelection& painted, const LonePiecesRequest& request,
                                    const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                    const Progress& progress);

}  // namespace strata::query
