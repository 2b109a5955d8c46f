#include "query/regions/distance_values.h"

#include <bit>
#include <limits>
#include <span>

#include "mesh/distance/surface_distance.h"

namespace strata::query {
namespace {

// `value_of` returns the bits for a texel that was reached.
template <class ValueOf>
Result<SurfaceValues> reached_values(std::span<const std::uint64_t> sources, double limit,
                                     const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                     Progress& progress, int threads, ValueOf value_of) {
  if (limit > double{std::numeric_limits<float>::max()})
    limit = std::numeric_limits<double>::infinity();
  const auto distances =
      STRATA_TRY(mesh::distances_along_surface(map, graph, sources, limit, progress, threads));
  const std::size_t slots = map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    values.valid[slot] = distances.reached_in(slot);
    for (std::uint64_t left = values.valid[slot]; left != 0; left &= left - 1) {
      const std::uint32_t texel = slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
      values.bits[texel] = value_of(distances, texel);
    }
  }
  return values;
}

}  // namespace

Result<SurfaceValues> distance_values(const TexelSelection& sources, double limit,
                                      const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                      Progress& progress, int threads) {
  return reached_values(sources, limit, map, graph, progress, threads,
                        [](const mesh::SurfaceDistances& distances, std::uint32_t texel) {
                          return std::bit_cast<std::uint32_t>(distances.at(texel));
                        });
}

Result<SurfaceValues> nearest_values(const SurfaceValues& values, double limit,
                                     const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                     Progress& progress, int threads) {
  return reached_values(values.valid, limit, map, graph, progress, threads,
                        [&](const mesh::SurfaceDistances& distances, std::uint32_t texel) {
                          return values.bits[distances.source_of(texel)];
                        });
}

}  // namespace strata::query
