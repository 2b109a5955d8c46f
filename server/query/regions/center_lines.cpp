#include "query/regions/center_lines.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/progress.h"
#include "mesh/distance/surface_distance.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/line_graph.h"
#include "query/regions/thinning.h"

namespace strata::query {
namespace {

// Returns all texels except those that are completely inside a piece.
std::vector<std::uint64_t> border_and_outside(const Pieces& pieces, const mesh::SurfaceMap& map,
                                              const mesh::TexelGraph& graph) {
  std::vector<std::uint64_t> bits = map.surface_mask;
  for (std::uint32_t texel = 0; texel < pieces.of_texel.size(); ++texel) {
    const std::uint32_t piece = pieces.of_texel[texel];
    if (piece == kNoRegion || (graph.at_open_edge[texel / 64] >> texel % 64 & 1u) != 0) continue;
    bool inside = true;
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      inside = inside && pieces.of_texel[other] == piece;
    });
    if (inside) bits[texel / 64] &= ~(std::uint64_t{1} << texel % 64);
  }
  return bits;
}

}  // namespace

Result<std::vector<LineMeasures>> measure_lines(const Pieces& pieces, const mesh::SurfaceMap& map,
                                                const mesh::TexelGraph& graph, Progress& progress,
                                                int threads) {
  const auto depths = STRATA_TRY(
      mesh::distances_along_surface(map, graph, border_and_outside(pieces, map, graph),
                                    std::numeric_limits<double>::infinity(), progress, threads));
  const auto texels = STRATA_TRY(thin_pieces(pieces, depths, map, graph, progress));
  const auto texel_size = [&](std::uint32_t texel) { return std::sqrt(double{map.area[texel]}); };
  const auto half_width = [&](std::uint32_t texel) {
    return double{depths.at(texel)} + texel_size(texel) / 2;
  };
  LineGraph lines(texels, pieces, map, graph, half_width);
  lines.prune(progress);
  if (progress.cancelled()) return cancelled_problem();
  std::vector<LineMeasures> measures(pieces.list.size());
  for (const auto& [texel, length] : lines.parts())
    measures[pieces.of_texel[texel]].length += length;
  // The center of a line may lie between two texels. This is half a texel on average.
  for (const std::uint32_t texel : texels) {
    double& greatest = measures[pieces.of_texel[texel]].greatest_width;
    greatest = std::max(greatest, 2 * half_width(texel) + texel_size(texel) / 2);
  }
  for (std::size_t i = 0; i < measures.size(); ++i) {
    LineMeasures& line = measures[i];
    if (line.length > 0) line.width = pieces.list[i].area / line.length;
    line.greatest_width = std::max(line.greatest_width, line.width);
  }
  return measures;
}

}  // namespace strata::query
