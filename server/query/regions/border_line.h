#pragma once

#include <cstdint>
#include <optional>

#include "core/error.h"
#include "query/conditions/texel_selection.h"
#include "query/regions/surface_values.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

struct BorderLine {
  // The regions with this value. Empty: the borders between any two values, or a value and no
  // value.
  std::optional<std::uint32_t> of{};
  double width = 0;  // model units, above 0
  // Whether the line is completely inside the regions, or half of it on each side. Without `of`,
  // every line is centered.
  bool inside = false;
};

// Selects the texels whose center is on the line along the borders. A narrow line has at least the
// texels next to the border: those inside the regions, or on both sides without `of`. The edge of
// the mesh and the seams of the atlas are no borders.
//
// Distances are measured along the surface (mesh/distance/surface_distance.h), from the texels at
// the border. A side of the line may be wrong by half a texel, because it follows the steps of the
// texels, and by the error of these distances. Takes time and memory like distances_along_surface.
// Fails when cancelled.
Result<TexelSelection> select_border_line(const SurfaceValues& values, const BorderLine& line,
                                          const mesh::SurfaceMap& map,
                                          const mesh::TexelGraph& graph, Progress& progress,
                                          int threads = 1);

}  // namespace strata::query
