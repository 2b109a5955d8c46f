#include "app/layers/cleanup.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "app/edits.h"
#include "app/records/painted_keys.h"
#include "mesh/parallel.h"
#include "query/regions/border_line.h"
#include "query/regions/majority.h"
#include "room/edit.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "room/surface.h"

namespace strata::app {
namespace {

// Bytes per texel of the map for the largest operation: the values before and after, the regions
// and the rows of a majority.
constexpr std::uint64_t kBytesPerTexel = 32;

Result<void> check_radius(double radius_m, const RegionSource& source) {
  const double largest_m = query::max_majority_radius(*source.map) * source.metres_per_unit;
  if (radius_m <= largest_m) return {};
  char largest[48];
  std::snprintf(largest, sizeof largest, "%.3g", std::floor(largest_m * 1e5) / 100);
  return fail(ErrorCode::invalid, "Radius too large",
              "The radius for the layer " + source.layer.name + " can be at most " + largest +
                  " mm, which is 40 texels. Choose a smaller radius.",
              "radius_mm");
}

// Returns the layer with the regions of a border. Users who see the painted layer must also be
// allowed to see the regions.
Result<RegionSource> source_of_border(const Services& services, room::Room& room,
                                      const RegionSource& target, LayerId from) {
  auto source = STRATA_TRY(region_source(services, room, from));
  if (source.layer.resolution != target.layer.resolution)
    return fail(ErrorCode::invalid, "Different resolutions",
                source.layer.name + " and " + target.layer.name +
                    " have different resolutions. Choose layers with the same resolution.",
                "from");
  if (source.layer.visibility > target.layer.visibility)
    return fail(ErrorCode::invalid, "Layer is hidden from some users",
                "Fewer users see " + source.layer.name + " than " + target.layer.name +
                    ". Choose a layer with the same visibility.",
                "from");
  return source;
}

Result<query::CleanedValues> painted_border(const RegionSource& target, const RegionSource& source,
                                            const Cleanup& cleanup, Progress& progress) {
  const query::BorderLine line{cleanup.of_bits, cleanup.width_m / target.metres_per_unit,
                               cleanup.inside};
  const auto selection = STRATA_TRY(
      query::select_border_line(source.values(), line, *target.map, *target.graph, progress));
  query::CleanedValues painted{target.values(), 0};
  for (std::uint32_t texel = 0; texel < painted.values.bits.size(); ++texel)
    if ((selection[texel / 64] >> texel % 64 & 1u) != 0) painted.values.set(texel, cleanup.line);
  return painted;
}

Result<query::CleanedValues> cleaned_values(const Services& services, room::Room& room,
                                            const RegionSource& target, const Cleanup& cleanup,
                                            Progress& progress) {
  const double units = 1 / target.metres_per_unit, area = cleanup.area_m2 * units * units;
  switch (cleanup.operation) {
    case Cleanup::Operation::sieve:
      return query::sieve(target.values(), area, cleanup.to, *target.map, *target.graph, progress);
    case Cleanup::Operation::fill_holes:
      return query::fill_holes(target.values(), area, *target.map, *target.graph, progress);
    case Cleanup::Operation::majority: {
      STRATA_TRY(check_radius(cleanup.radius_m, target));
      auto values =
          STRATA_TRY(query::majority(target.values(), cleanup.radius_m * units, *target.map,
                                     *target.graph, progress, mesh::background_threads()));
      return query::CleanedValues{std::move(values), 0};
    }
    case Cleanup::Operation::border: break;
  }
  if (!cleanup.from || *cleanup.from == target.layer.id)
    return painted_border(target, target, cleanup, progress);
  const auto source = STRATA_TRY(source_of_border(services, room, target, *cleanup.from));
  return painted_border(target, source, cleanup, progress);
}

}  // namespace

Result<RegionSource> region_source(const Services& services, room::Room& room, LayerId layer_id) {
  auto layer = STRATA_TRY(room.layers().find(to_string(layer_id)));
  auto map = STRATA_TRY(room.surface().map(layer.resolution));
  auto graph = STRATA_TRY(room.surface().graph(layer.resolution));
  auto memory = STRATA_TRY(services.rooms.memory().reserve(
      map->block_of_slot.size() * 64 * kBytesPerTexel, "the regions of a layer"));
  auto snapshot = STRATA_TRY(room.queries().tiles(layer.slug, {}));
  return RegionSource{std::move(layer), std::move(snapshot.tiles), std::move(map),
                      std::move(graph), room.model().metres(),     std::move(memory)};
}

Result<CleanupResult> apply_patch(const Services& services, room::Room& room,
                                  const RegionSource& target, query::TexelPatch patch,
                                  const CleanupEdit& edit, std::vector<std::int64_t> keys,
                                  Progress& progress) {
  CleanupResult result;
  result.texels = patch.texels;
  result.area_m2 = patch.area * target.metres_per_unit * target.metres_per_unit;
  if (progress.cancelled()) return cancelled_problem();
  if (!edit.apply || patch.empty()) return result;
  room::EditRequest request{edit.id, edit.author, target.layer.id};
  request.record = edit.record;
  request.edit = room::PatchEdit{std::move(patch), target.layer.type, target.layer.resolution,
                                 std::move(keys)};
  STRATA_TRY(check_keys(services.store, target.layer, room::painted_by(target.layer, request)));
  const auto answer = STRATA_TRY(edit_and_wait(room, std::move(request), services.edits));
  result.applied = true;
  result.skipped_texels =
      answer.repeated ? 0 : result.texels - std::min(result.texels, answer.texels_changed);
  result.texels = answer.texels_changed;
  result.area_m2 = answer.area_m2;
  result.sequence = answer.sequence;
  result.provisional = answer.provisional;
  result.repeated = answer.repeated;
  return result;
}

Result<CleanupResult> clean_up(const Services& services, room::Room& room, const Layer& layer,
                               const Cleanup& cleanup, const CleanupEdit& edit,
                               Progress& progress) {
  if (edit.apply) STRATA_TRY(room::check_not_locked(layer, edit.author.role));
  progress.report(0, "Reading the layer");
  const RegionSource target = STRATA_TRY(region_source(services, room, layer.id));
  progress.begin_stage(0.05, 0.9);
  auto cleaned = STRATA_TRY(cleaned_values(services, room, target, cleanup, progress));
  progress.begin_stage(0.9, 1);
  progress.report(0, "Saving the result");
  auto patch =
      query::make_patch(target.tiles, target.layer.type, *target.map, std::move(cleaned.values));
  std::vector<std::int64_t> keys;
  if (target.layer.kind == LayerKind::database && cleanup.line.valid)
    keys.push_back(cleanup.line.bits);
  auto result = STRATA_TRY(
      apply_patch(services, room, target, std::move(patch), edit, std::move(keys), progress));
  result.regions = cleaned.regions;
  return result;
}

}  // namespace strata::app
