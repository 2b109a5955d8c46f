#include "query/regions/lone_pieces.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"

namespace strata::query {
namespace {

struct Sums {
  double known_area = 0;
  bool overlaps = false;
  glm::dvec3 weighted_position{0};
};

// Calls visit(slot, texel in the slot, region) for each texel with a value.
template <class Visit>
Result<void> for_each_painted(const SurfaceValues& values, const Regions& regions,
                              const Progress& progress, Visit visit) {
  for (std::uint32_t slot = 0; slot < values.valid.size(); ++slot) {
    if (slot % 4096 == 0 && progress.cancelled()) return cancelled_problem();
    for (std::uint64_t left = values.valid[slot]; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      visit(slot, i, regions.of_texel[slot * 64 + static_cast<std::uint32_t>(i)]);
    }
  }
  return {};
}

}  // namespace

Result<LonePieces> find_lone_pieces(const SurfaceValues& values, const TexelSelection& known,
                                    const TexelSelection& painted, const LonePiecesRequest& request,
                                    const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                    const Progress& progress) {
  const auto regions = STRATA_TRY(find_regions(values, map, graph, progress));
  std::vector<Sums> sums(regions.list.size());
  STRATA_TRY(for_each_painted(
      values, regions, progress, [&](std::uint32_t slot, int i, std::uint32_t region) {
        const double area = map.area[std::size_t{slot} * 64 + static_cast<std::size_t>(i)];
        Sums& sum = sums[region];
        sum.weighted_position += area * glm::dvec3(map.position(slot, i));
        if ((known[slot] >> i & 1u) != 0) sum.known_area += area;
        sum.overlaps |= (painted[slot] >> i & 1u) != 0;
      }));

  LonePieces pieces;
  std::vector<std::uint32_t> lone;
  for (std::uint32_t i = 0; i < regions.list.size(); ++i) {
    const Region& region = regions.list[i];
    if (!region.value.valid || sums[i].overlaps || region.area < request.min_area ||
        !(sums[i].known_area > region.area / 2))
      continue;
    lone.push_back(i);
    ++pieces.count;
    pieces.area += region.area;
  }
  std::ranges::stable_sort(lone, [&](std::uint32_t a, std::uint32_t b) {
    return regions.list[a].area > regions.list[b].area;
  });
  if (lone.size() > request.max_listed) lone.resize(request.max_listed);

  std::vector<std::uint32_t> piece_of(regions.list.size(), kNoRegion);
  for (const std::uint32_t i : lone) {
    piece_of[i] = static_cast<std::uint32_t>(pieces.list.size());
    pieces.list.push_back({regions.list[i].value, regions.list[i].area, {}});
  }
  std::vector<double> nearest(pieces.list.size(), std::numeric_limits<double>::infinity());
  STRATA_TRY(for_each_painted(
      values, regions, progress, [&](std::uint32_t slot, int i, std::uint32_t region) {
        const std::uint32_t piece = piece_of[region];
        if (piece == kNoRegion) return;
        const glm::vec3 position = map.position(slot, i);
        const glm::dvec3 center = sums[region].weighted_position / regions.list[region].area;
        const double distance = glm::distance(glm::dvec3(position), center);
        if (distance >= nearest[piece]) return;
        nearest[piece] = distance;
        pieces.list[piece].at = position;
      }));
  return pieces;
}

}  // namespace strata::query
