#include "query/regions/majority.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "mesh/parallel.h"
#include "query/regions/border_texels.h"
#include "query/regions/neighborhood_limits.h"
#include "query/regions/row_runs.h"
#include "query/regions/texel_discs.h"
#include "query/regions/value_areas.h"

namespace strata::query {
namespace {

// Sums the areas around texels. One object for each thread.
class Neighbourhoods {
 public:
  Neighbourhoods(const SurfaceValues& values, const RowRuns& rows, const mesh::SurfaceMap& map,
                 const mesh::TexelGraph& graph, double radius)
      : values_(values), rows_(rows), discs_(map, graph, radius) {}

  TexelValue majority(std::uint32_t texel) {
    areas_.clear();
    const auto add = [&](const TexelValue& value, std::uint32_t area) { areas_.add(value, area); };
    if (!discs_.for_each_chord(
            texel, [&](int y, int x0, int x1) { return rows_.for_each_run(y, x0, x1, add); })) {
      areas_.clear();
      for (const auto& [slot, bits] : discs_.balls().around(texel))
        for (std::uint64_t left = bits; left != 0; left &= left - 1) {
          const std::uint32_t other =
              slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
          add(values_.of(other), rows_.area(other));
        }
    }
    return areas_.largest(values_.of(texel));
  }

 private:
  const SurfaceValues& values_;
  const RowRuns& rows_;
  TexelDiscs discs_;
  ValueAreas areas_;
};

// Returns the texels whose value may change. Where the nearest border is at d, the disc of radius d
// has the value of the texel. In a neighborhood without narrow necks, that is at least a part
// (d / radius)² of the area, and so more than half of it for d above 0.71 radius.
Result<std::vector<std::uint64_t>> changeable_texels(const SurfaceValues& values, double radius,
                                                     const mesh::SurfaceMap& map,
                                                     const mesh::TexelGraph& graph,
                                                     const Progress& progress) {
  const auto at_border = STRATA_TRY(texels_at_borders(
      map, graph, [&](std::uint32_t a, std::uint32_t b) { return !values.same(a, b); }, progress));
  const double limit = std::min(radius, 0.75 * radius + mean_texel_size(map));
  return texels_near_borders(map, graph, at_border, static_cast<float>(limit), progress);
}

}  // namespace

Result<SurfaceValues> majority(SurfaceValues values, const MajorityRequest& request,
                               const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                               Progress& progress, int threads) {
  if (map.surface_texels == 0) return values;
  const double radius = request.radius, texel_size = mean_texel_size(map);
  STRATA_TRY(check_majority_radius(radius, texel_size, request.metres_per_unit));
  constexpr const char* kCounting = "Comparing areas";
  progress.report(0, "Finding borders");
  const auto near = STRATA_TRY(changeable_texels(values, radius, map, graph, progress));
  double count = 0;
  for (const std::uint64_t bits : near) count += std::popcount(bits);
  if (count * radius * radius > request.max_work * texel_size * texel_size)
    return fail(ErrorCode::invalid, "Radius too large",
                "The layer has so many borders that the radius can be at most " +
                    millimetres_for_message(std::sqrt(request.max_work / count) * texel_size *
                                            request.metres_per_unit) +
                    ". Choose a smaller radius, or remove small regions first.",
                "radius_mm");
  progress.report(0.2, kCounting);
  const RowRuns rows(values, map, graph, progress, threads);

  constexpr std::size_t kSlotsAtOnce = 256;
  const std::size_t parts = (near.size() + kSlotsAtOnce - 1) / kSlotsAtOnce;
  std::vector<std::vector<std::pair<std::uint32_t, TexelValue>>> changes(parts);
  std::atomic<std::size_t> done{0};
  mesh::parallel_for(threads, static_cast<int>(parts), [&](int number) {
    const auto part = static_cast<std::size_t>(number);
    std::optional<Neighbourhoods> around;
    for (std::size_t slot = part * kSlotsAtOnce;
         slot < std::min(near.size(), (part + 1) * kSlotsAtOnce); ++slot)
      for (std::uint64_t left = near[slot]; left != 0; left &= left - 1) {
        if (progress.cancelled()) return;
        if (!around) around.emplace(values, rows, map, graph, radius);
        const auto at = static_cast<std::uint32_t>(
            slot * 64 + static_cast<std::size_t>(std::countr_zero(left)));
        const TexelValue value = around->majority(at);
        if (value != values.of(at)) changes[part].emplace_back(at, value);
      }
    progress.report(0.2 + 0.8 * double(++done) / double(parts), kCounting);
  });
  if (progress.cancelled()) return cancelled_problem();
  for (const auto& part : changes)
    for (const auto& [texel, value] : part) values.set(texel, value);
  return values;
}

}  // namespace strata::query
