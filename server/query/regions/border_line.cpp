#include "query/regions/border_line.h"

#include <bit>
#include <cmath>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/border_distance.h"

namespace strata::query {

Result<TexelSelection> select_border_line(const SurfaceValues& values, const BorderLine& line,
                                          const mesh::SurfaceMap& map,
                                          const mesh::TexelGraph& graph, Progress& progress) {
  const auto is_in = [&](std::uint32_t texel) {
    return values.of(texel) == TexelValue{*line.of, true};
  };
  const auto is_border = [&](std::uint32_t a, std::uint32_t b) {
    return line.of ? is_in(a) != is_in(b) : !values.same(a, b);
  };
  const bool inside = line.of && line.inside;
  const auto reach = static_cast<float>(inside ? line.width : line.width / 2);
  progress.report(0, "Measuring distances to borders");
  const auto distances = STRATA_TRY(border_distances(map, graph, is_border, reach, progress));
  const auto is_beside_border = [&](std::uint32_t texel) {
    if (line.of && !is_in(texel)) return false;
    bool beside = false;
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      beside = beside || is_border(texel, other);
    });
    return beside;
  };
  TexelSelection selection(map.block_of_slot.size(), 0);
  for (std::uint32_t slot = 0; slot < selection.size(); ++slot) {
    if (slot % 4096 == 0 && progress.cancelled()) return cancelled_problem();
    for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      const std::uint32_t texel = slot * 64 + static_cast<std::uint32_t>(i);
      const bool near = std::isfinite(distances[texel]) && (!inside || is_in(texel));
      if (near || is_beside_border(texel)) selection[slot] |= std::uint64_t{1} << i;
    }
  }
  return selection;
}

}  // namespace strata::query
