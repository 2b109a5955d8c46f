#include "app/layers/cleanup.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "app/authorization/visibility_leak_check.h"
#include "app/edits.h"
#include "app/layers/reserved_regions.h"
#include "app/records/painted_keys.h"
#include "domain/scene/model_measures.h"
#include "mesh/parallel.h"
#include "query/regions/border_line.h"
#include "query/regions/majority.h"
#include "query/regions/neighborhood_limits.h"
#include "query/regions/open_close.h"
#include "room/edit.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "room/surface.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"

namespace strata::app {
namespace {

// The largest memory of an operation per texel of the map: the values before and after, and the
// work of a majority, or distances along the surface.
constexpr std::uint64_t kBytesPerTexel = 40;

constexpr const char* kResult = "result";  // member of the record of an edit

tl::unexpected<Error> key_used() {
  return fail(ErrorCode::invalid, "Idempotency-Key already used",
              "Another edit has used this Idempotency-Key. Use a new key for a new edit.",
              "Idempotency-Key");
}

Result<query::CleanedValues> painted_border(const Services& services, const RegionSource& target,
                                            const RegionSource& source, const Cleanup& cleanup,
                                            Progress& progress) {
  const auto memory = STRATA_TRY(reserve_distances(services, *target.graph));
  const query::BorderLine line{cleanup.of_bits, cleanup.width_m / target.metres_per_unit,
                               cleanup.inside};
  const auto selection = STRATA_TRY(query::select_border_line(
      source.values(), line, *target.map, *target.graph, progress, mesh::background_threads()));
  query::CleanedValues painted{target.values(), 0};
  for (std::uint32_t texel = 0; texel < painted.values.bits.size(); ++texel) {
    if (texel % (1 << 18) == 0 && progress.cancelled()) return cancelled_problem();
    if ((selection[texel / 64] >> texel % 64 & 1u) != 0) painted.values.set(texel, cleanup.line);
  }
  return painted;
}

// Returns the value for open and close.
Result<std::uint32_t> value_of_regions(const query::SurfaceValues& values, const Cleanup& cleanup) {
  if (cleanup.of_bits) return *cleanup.of_bits;
  std::optional<std::uint32_t> only;
  for (std::uint32_t texel = 0; texel < values.bits.size(); ++texel) {
    const query::TexelValue value = values.of(texel);
    if (!value.valid || value.bits == only) continue;
    if (only)
      return fail(ErrorCode::invalid, "Value missing",
                  "The layer has several values. Choose the value of the regions.", "of");
    only = value.bits;
  }
  return only.value_or(0);
}

Result<query::CleanedValues> opened_or_closed(const Services& services, const RegionSource& target,
                                              const Cleanup& cleanup, Progress& progress) {
  const auto memory = STRATA_TRY(reserve_distances(services, *target.graph));
  auto values = target.values();
  const std::uint32_t of = STRATA_TRY(value_of_regions(values, cleanup));
  const double radius = cleanup.width_m / 2 / target.metres_per_unit;
  const bool opens = cleanup.operation == Cleanup::Operation::open;
  auto after = STRATA_TRY((opens ? query::open_value : query::close_value)(
      std::move(values), of, radius, *target.map, *target.graph, progress,
      mesh::background_threads()));
  return query::CleanedValues{std::move(after), 0};
}

Result<query::CleanedValues> cleaned_values(const Services& services, room::Room& room,
                                            const RegionSource& target, const Cleanup& cleanup,
                                            Progress& progress) {
  const double units = 1 / target.metres_per_unit, area = cleanup.area_m2 * units * units;
  switch (cleanup.operation) {
    case Cleanup::Operation::sieve: {
      auto values = target.values();
      const auto found =
          STRATA_TRY(find_reserved_regions(services, values, *target.map, *target.graph, progress));
      progress.begin_stage(0.4, 0.9);
      return query::sieve(std::move(values), found.regions, area, cleanup.to, *target.map,
                          *target.graph, progress);
    }
    case Cleanup::Operation::fill_holes: {
      auto values = target.values();
      const auto found =
          STRATA_TRY(find_reserved_regions(services, values, *target.map, *target.graph, progress));
      progress.begin_stage(0.4, 0.9);
      return query::fill_holes(std::move(values), found.regions, area, *target.map, *target.graph,
                               progress);
    }
    case Cleanup::Operation::majority: {
      auto values = STRATA_TRY(
          query::majority(target.values(), {cleanup.radius_m * units, target.metres_per_unit},
                          *target.map, *target.graph, progress, mesh::background_threads()));
      return query::CleanedValues{std::move(values), 0};
    }
    case Cleanup::Operation::open:
    case Cleanup::Operation::close: return opened_or_closed(services, target, cleanup, progress);
    case Cleanup::Operation::border: break;
  }
  if (!cleanup.from || *cleanup.from == target.layer.id)
    return painted_border(services, target, target, cleanup, progress);
  const auto source = STRATA_TRY(region_source(services, room, *cleanup.from));
  STRATA_TRY(check_can_show(target.layer, source.layer, "from"));
  return painted_border(services, target, source, cleanup, progress);
}

// The part of a result that only the record of the edit contains. The keys of new records are
// consecutive.
nlohmann::json stored(const CleanupResult& result) {
  nlohmann::json json{{"regions", result.regions}};
  if (!result.keys.empty()) json["first_key"] = result.keys.front();
  return json;
}

CleanupResult stored_result(const nlohmann::json& json) {
  CleanupResult result;
  result.regions = json.value("regions", std::uint64_t{0});
  if (json.contains("first_key")) {
    result.keys.resize(result.regions);
    std::iota(result.keys.begin(), result.keys.end(), json["first_key"].get<std::int64_t>());
  }
  return result;
}

// An edit without texels changes nothing, although the journal contains it. Its new records are
// deleted.
void read_answer(CleanupResult& result, const room::EditAnswer& answer) {
  result.applied = answer.texels_changed > 0;
  if (!result.applied) {
    result.regions = 0;
    result.keys.clear();
  }
  result.texels = answer.texels_changed;
  result.area_m2 = answer.area_m2;
  result.sequence = answer.sequence;
  result.provisional = answer.provisional;
}

}  // namespace

Result<RegionSource> region_source(const Services& services, room::Room& room, LayerId layer_id) {
  auto layer = STRATA_TRY(room.layers().find(to_string(layer_id)));
  auto map = STRATA_TRY(room.surface().map(layer.resolution));
  auto graph = STRATA_TRY(room.surface().graph(layer.resolution));
  auto memory = STRATA_TRY(services.rooms.memory().reserve(
      map->block_of_slot.size() * 64 * kBytesPerTexel, "the regions of a layer"));
  auto snapshot = STRATA_TRY(room.queries().tiles(to_string(layer.id), {}));
  return RegionSource{std::move(layer), std::move(snapshot.tiles), std::move(map),
                      std::move(graph), room.model().metres(),     std::move(memory)};
}

Result<void> check_can_show(const Layer& painted, const Layer& source, const std::string& field) {
  if (source.resolution != painted.resolution)
    return fail(ErrorCode::invalid, "Different resolutions",
                source.name + " and " + painted.name +
                    " have different resolutions. Choose layers with the same resolution.",
                field);
  return check_all_may_see(source, painted, field);
}

Result<CleanupResult> apply_patch(const Services& services, room::Room& room,
                                  const RegionSource& target, query::TexelPatch patch,
                                  CleanupResult result, const CleanupEdit& edit,
                                  Progress& progress) {
  result.texels = patch.texels;
  result.area_m2 = patch.area * target.metres_per_unit * target.metres_per_unit;
  if (progress.cancelled()) return cancelled_problem();
  if (!edit.apply || patch.empty()) return result;
  room::EditRequest request{edit.id, edit.author, target.layer.id};
  request.record = edit.record;
  request.record[kResult] = stored(result);
  std::vector<std::int64_t> keys;
  if (target.layer.kind == LayerKind::database) keys = room::keys_in(patch);
  STRATA_TRY(check_keys(services.store, target.layer, keys));
  request.edit = room::PatchEdit{std::move(patch), target.layer.type, target.layer.resolution,
                                 std::move(keys)};
  const auto answer = STRATA_TRY(edit_and_wait(room, std::move(request), services.edits));
  if (answer.repeated) {  // the answer belongs to another job with the same id
    auto saved = STRATA_TRY(find_saved(services, room.model().id, edit));
    return saved ? std::move(*saved) : Result<CleanupResult>(key_used());
  }
  result.skipped_texels = result.texels - std::min(result.texels, answer.texels_changed);
  read_answer(result, answer);
  return result;
}

Result<std::optional<CleanupResult>> find_saved(const Services& services, ModelId model,
                                                const CleanupEdit& edit) {
  const auto journal = STRATA_TRY(services.store.journal().state(model, std::span(&edit.id, 1)));
  if (journal.known.empty()) return std::nullopt;
  const store::JournalRow& row = journal.known.front();
  CleanupResult result;
  if (row.op != "checkpoint") {  // a thinned journal no longer has the record
    nlohmann::json record = row.record;
    if (record.is_object()) {
      result = stored_result(record.value(kResult, nlohmann::json::object()));
      record.erase(kResult);
    }
    if (record != edit.record) return key_used();
  }
  read_answer(result, room::idempotent_response(row));
  return result;
}

Result<void> check_radius(const Model& model, const Layer& layer, const Cleanup& cleanup) {
  const auto texel_size = reported_texel_size(model.atlas, layer.resolution);
  if (!texel_size || cleanup.operation != Cleanup::Operation::majority) return {};
  return query::check_majority_radius(cleanup.radius_m / model.metres(), *texel_size,
                                      model.metres());
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
  auto patch = STRATA_TRY(query::make_patch(target.tiles, target.layer.type, *target.map,
                                            std::move(cleaned.values), progress));
  CleanupResult counted;
  counted.regions = cleaned.regions;
  return apply_patch(services, room, target, std::move(patch), std::move(counted), edit, progress);
}

}  // namespace strata::app
