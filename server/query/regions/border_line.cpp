#include "query/regions/border_line.h"

#include <algorithm>
#include <bit>
#include <glm/glm.hpp>
#include <limits>

#include "core/progress.h"
#include "mesh/distance/surface_distance.h"
#include "mesh/parallel.h"
#include "query/regions/border_texels.h"

namespace strata::query {
namespace {

// Texels whose distance equals the limit are on the line, in spite of rounding errors.
constexpr float kRim = 1 + 1e-4f;

}  // namespace

Result<TexelSelection> select_border_line(const SurfaceValues& values, const BorderLine& line,
                                          const mesh::SurfaceMap& map,
                                          const mesh::TexelGraph& graph, Progress& progress,
                                          int threads) {
  const auto is_in = [&](std::uint32_t texel) {
    return values.of(texel) == TexelValue{*line.of, true};
  };
  const auto is_border = [&](std::uint32_t a, std::uint32_t b) {
    return line.of ? is_in(a) != is_in(b) : !values.same(a, b);
  };
  const bool inside = line.of && line.inside;
  const float reach = static_cast<float>(inside ? line.width : line.width / 2) * kRim;
  progress.report(0, "Finding borders");
  const auto at_border = STRATA_TRY(texels_at_borders(map, graph, is_border, progress));
  const auto distances =
      STRATA_TRY(mesh::distances_along_surface(map, graph, at_border, reach, progress, threads));
  const auto place = [&](std::uint32_t texel) {
    return map.position(texel / 64, static_cast<int>(texel % 64));
  };
  // The distance from a texel at the border to the border, which is half a texel away.
  const auto to_border = [&](std::uint32_t texel) {
    float least = std::numeric_limits<float>::infinity();
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      if (is_border(texel, other))
        least = std::min(least, glm::distance(place(texel), place(other)) / 2);
    });
    return least;
  };
  const auto is_on_line = [&](std::uint32_t texel) {
    const bool in = !line.of || is_in(texel);
    if (in && distances.is_source(texel)) return true;  // the narrowest line
    return (in || !inside) && distances.at(texel) + to_border(distances.source_of(texel)) <= reach;
  };
  TexelSelection selection(map.block_of_slot.size(), 0);
  constexpr std::size_t kSlotsAtOnce = 1024;
  const std::size_t parts = (selection.size() + kSlotsAtOnce - 1) / kSlotsAtOnce;
  mesh::parallel_for(threads, static_cast<int>(parts), [&](int part) {
    if (progress.cancelled()) return;
    const std::size_t first = static_cast<std::size_t>(part) * kSlotsAtOnce;
    for (std::size_t slot = first; slot < std::min(selection.size(), first + kSlotsAtOnce); ++slot)
      for (std::uint64_t left = distances.reached_in(static_cast<std::uint32_t>(slot)); left != 0;
           left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        if (is_on_line(static_cast<std::uint32_t>(slot * 64 + i)))
          selection[slot] |= std::uint64_t{1} << i;
      }
  });
  if (progress.cancelled()) return cancelled_problem();
  return selection;
}

}  // namespace strata::query
