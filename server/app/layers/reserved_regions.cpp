#include "app/layers/reserved_regions.h"

#include <cstddef>
#include <string>
#include <utility>

#include "room/rooms.h"

namespace strata::app {

Result<MemoryLedger::Share> reserve_distances(const Services& services,
                                              const mesh::TexelGraph& graph) {
  return services.rooms.memory().reserve(graph.linked_texels() * kBytesPerLinkedTexel,
                                         "distances on the surface of a layer");
}

Result<ReservedRegions> find_reserved_regions(const Services& services,
                                              const query::SurfaceValues& values,
                                              const mesh::SurfaceMap& map,
                                              const mesh::TexelGraph& graph, Progress& progress) {
  progress.report(0, "Finding regions");
  auto regions = STRATA_TRY(query::find_regions(values, map, graph, progress));
  const std::size_t count = regions.list.size();
  auto memory = STRATA_TRY(services.rooms.memory().reserve(
      count * query::kBytesPerRegion,
      std::to_string(count) + " regions of a layer (smoothing by majority first reduces them)"));
  return ReservedRegions{std::move(regions), std::move(memory)};
}

}  // namespace strata::app
