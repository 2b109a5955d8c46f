#pragma once

#include <cstdint>

#include "app/services.h"
#include "core/memory_ledger.h"
#include "core/progress.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/regions.h"

// The memory of operations on the regions of a layer, reserved before they begin.
namespace strata::app {

// Distances along the surface need about 1 KiB for each texel within two steps of a seam. For each
// texel at a seam, there are about three such texels.
constexpr std::uint64_t kBytesPerLinkedTexel = 3 * 1024;
// Reserves the memory for distances along the surface near its seams.
Result<MemoryLedger::Share> reserve_distances(const Services& services,
                                              const mesh::TexelGraph& graph);

// The regions of a layer, and the memory for them and for operations on them.
struct ReservedRegions {
  query::Regions regions;
  MemoryLedger::Share memory;
};
Result<ReservedRegions> find_reserved_regions(const Services& services,
                                              const query::SurfaceValues& values,
                                              const mesh::SurfaceMap& map,
                                              const mesh::TexelGraph& graph, Progress& progress);

}  // namespace strata::app
