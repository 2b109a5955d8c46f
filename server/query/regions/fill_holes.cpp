#include <optional>
#include <vector>

#include "mesh/texels/texel_graph.h"
#include "query/regions/sieve.h"

namespace strata::query {
namespace {

// The values of the texels around a hole.
struct Around {
  std::optional<TexelValue> value{};
  bool is_mixed = false;
};

}  // namespace

Result<CleanedValues> fill_holes(SurfaceValues values, const Regions& regions, double max_area,
                                 const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                 Progress& progress) {
  const auto is_candidate = [&](const Region& region) {
    return !region.value.valid && !region.at_open_edge && region.area < max_area;
  };
  progress.report(0, "Finding enclosed regions");
  std::vector<Around> around(regions.list.size());
  const auto look_around = [&](std::uint32_t texel, std::uint32_t region) {
    if (!is_candidate(regions.list[region])) return;
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      if (regions.of_texel[other] == region) return;
      Around& of = around[region];
      const TexelValue value = values.of(other);
      of.is_mixed |= of.value.value_or(value) != value;
      of.value = value;
    });
  };
  if (!for_each_texel_of_regions(regions, map, progress, look_around)) return cancelled_problem();
  progress.report(0.8, "Filling enclosed regions");
  std::vector<std::optional<TexelValue>> new_values(regions.list.size());
  for (std::size_t i = 0; i < around.size(); ++i)
    if (!around[i].is_mixed) new_values[i] = around[i].value;
  return recolored(std::move(values), regions, new_values, map, progress);
}

}  // namespace strata::query
