#include "query/regions/dilate_erode.h"

#include <cmath>

#include "core/progress.h"
#include "mesh/distance/surface_distance.h"
#include "mesh/texels/surface_map.h"
#include "query/regions/texel_discs.h"

namespace strata::query {
namespace {

// Distances along the surface, and sets before and after them (surface_distance.h).
constexpr std::uint64_t kBytesPerTexel = 9, kBytesPerSlot = 12 + 4 * sizeof(std::uint64_t),
                        kBytesPerLinkedTexel = 1024;

}  // namespace

TexelSelection reached_texels(const mesh::SurfaceDistances& distances,
                              const mesh::SurfaceMap& map) {
  TexelSelection reached(map.block_of_slot.size());
  for (std::uint32_t slot = 0; slot < reached.size(); ++slot)
    reached[slot] = distances.reached_in(slot);
  return reached;
}

TexelSelection surface_outside(const TexelSelection& set, const mesh::SurfaceMap& map) {
  TexelSelection rest(set.size());
  for (std::size_t slot = 0; slot < set.size(); ++slot)
    rest[slot] = map.surface_mask[slot] & ~set[slot];
  return rest;
}

Result<TexelSelection> dilate(const TexelSelection& set, double radius, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, Progress& progress, int threads) {
  const auto distances =
      STRATA_TRY(mesh::distances_along_surface(map, graph, set, radius * kRim, progress, threads));
  return reached_texels(distances, map);
}

Result<TexelSelection> erode(const TexelSelection& set, double radius, const mesh::SurfaceMap& map,
                             const mesh::TexelGraph& graph, Progress& progress, int threads) {
  const auto lost =
      STRATA_TRY(dilate(surface_outside(set, map), radius, map, graph, progress, threads));
  return surface_outside(lost, map);
}

Result<TexelSelection> grow(const TexelSelection& set, double distance, const mesh::SurfaceMap& map,
                            const mesh::TexelGraph& graph, Progress& progress, int threads) {
  const double radius = std::abs(distance) + mean_texel_size(map) / 2;
  return (distance < 0 ? erode : dilate)(set, radius, map, graph, progress, threads);
}

Result<TexelSelection> smooth(const TexelSelection& set, double width, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, Progress& progress, int threads) {
  TexelSelection smoothed = set;
  for (const auto step : {erode, dilate, dilate, erode})
    smoothed = STRATA_TRY(step(smoothed, width / 2, map, graph, progress, threads));
  return smoothed;
}

std::uint64_t bytes_to_dilate(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph) {
  const std::uint64_t slots = map.block_of_slot.size();
  return slots * (64 * kBytesPerTexel + kBytesPerSlot) +
         graph.linked_texels() * kBytesPerLinkedTexel;
}

}  // namespace strata::query
