#include "app/layers/piece_records.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <utility>

#include "app/change_notifier.h"
#include "app/layers/reserved_regions.h"
#include "app/records/painted_keys.h"
#include "core/log.h"
#include "mesh/parallel.h"
#include "query/regions/center_lines.h"
#include "query/regions/reading_order.h"
#include "query/regions/region_pieces.h"
#include "query/statistics/key_areas.h"
#include "room/edit.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/table_changes.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

// Checks that the keys of the pieces can be painted on a layer.
Result<void> check_target(const RegionSource& source, const RegionSource& target,
                          const CleanupEdit& edit) {
  if (!target.layer.table)
    return fail(ErrorCode::invalid, "No table",
                target.layer.name + " is not a layer of records. Choose a layer of records.",
                "into");
  if (target.layer.id == source.layer.id)
    return fail(ErrorCode::invalid, "Same layer",
                "The pieces and their records need different layers. Choose another layer of "
                "records.",
                "into");
  STRATA_TRY(check_can_show(target.layer, source.layer, "into"));
  return edit.apply ? room::check_not_locked(target.layer, edit.author.role) : Result<void>();
}

// The pieces, and their measures as lines if they were requested.
struct FoundPieces {
  query::Pieces pieces;
  std::vector<query::LineMeasures> lines;
};

Result<void> put_in_reading_order(const room::Room& room, query::Pieces& pieces,
                                  const Progress& progress) {
  std::vector<glm::dvec3> centers;
  for (const query::Piece& piece : pieces.list) centers.push_back(piece.center);
  return query::reorder(pieces, query::reading_order(centers, up_frame(room.model().up)), progress);
}

Result<void> measure_as_lines(const Services& services, const RegionSource& source,
                              FoundPieces& found, Progress& progress) {
  const auto memory = STRATA_TRY(reserve_distances(services, *source.graph));
  progress.begin_stage(0.4, 0.8);
  found.lines = STRATA_TRY(query::measure_lines(found.pieces, *source.map, *source.graph, progress,
                                                mesh::background_threads()));
  return {};
}

Result<FoundPieces> found_pieces(const Services& services, room::Room& room,
                                 const RegionSource& source, const PieceRecords& request,
                                 bool with_measures, Progress& progress) {
  query::PieceRequest pieces;
  pieces.of = request.of_bits;
  pieces.min_area = request.min_area_m2 / (source.metres_per_unit * source.metres_per_unit);
  pieces.max_pieces = kMaxPieceRecords;
  if (request.as_lines) pieces.connection = query::Connection::corners;
  FoundPieces found;
  progress.begin_stage(0.05, request.as_lines ? 0.4 : 0.8);
  found.pieces = STRATA_TRY(query::find_pieces(source.values(), pieces, *source.map, *source.graph,
                                               progress, mesh::background_threads()));
  if (!with_measures) return found;
  if (request.in_reading_order) STRATA_TRY(put_in_reading_order(room, found.pieces, progress));
  if (request.as_lines) STRATA_TRY(measure_as_lines(services, source, found, progress));
  return found;
}

store::WriteRecords records_of(const FoundPieces& found, const PieceRecords& request,
                               double metres_per_unit) {
  const query::Pieces& pieces = found.pieces;
  const double cm2 = 1e4 * metres_per_unit * metres_per_unit, mm = 1e3 * metres_per_unit;
  // Digits beyond the precision of the measurement would only fill the table.
  const auto rounded = [](double value) { return std::round(value * 1e4) / 1e4; };
  store::WriteRecords write;
  write.may_change = false;
  for (std::size_t i = 0; i < pieces.list.size(); ++i) {
    store::RecordInput record;
    if (request.number) record.values[*request.number] = i + 1;
    if (request.area_cm2) record.values[*request.area_cm2] = rounded(pieces.list[i].area * cm2);
    if (request.perimeter_mm)
      record.values[*request.perimeter_mm] = rounded(pieces.list[i].perimeter * mm);
    if (request.as_lines) {
      const query::LineMeasures& line = found.lines[i];
      if (request.length_mm) record.values[*request.length_mm] = rounded(line.length * mm);
      if (request.width_mm) record.values[*request.width_mm] = rounded(line.width * mm);
      if (request.greatest_width_mm)
        record.values[*request.greatest_width_mm] = rounded(line.greatest_width * mm);
    }
    write.records.push_back(std::move(record));
  }
  return write;
}

Result<void> check_written(const store::TableChange& change) {
  if (change.problems.empty()) return {};
  Error problem = change.problems.front().problem;
  problem.detail = "The records cannot be created, so nothing was changed. " + problem.detail;
  return tl::unexpected(std::move(problem));
}

Result<void> check_keys_fit(const store::TableChange& change, const Layer& target) {
  if (static_cast<double>(change.created.back()) > highest_value(target.type))
    return fail(ErrorCode::invalid, "Key too large",
                target.name + " can store keys up to " +
                    std::to_string(static_cast<std::int64_t>(highest_value(target.type))) +
                    ". Change the layer to a wider type first.",
                "into");
  return {};
}

Result<store::TableChange> create_records(const Services& services,
                                          const store::WriteRecords& write, const Table& table,
                                          const std::string& user) {
  auto change = services.store.records().write(table.id, write, user);
  if (!change && change.error().code == ErrorCode::unavailable)
    change.error().detail =
        "The database did not confirm whether the records of the table " + table.name +
        " were created. If the table has new records without texels, delete them with Undo in the "
        "table. Then start again.";
  if (change) STRATA_TRY(check_written(*change));
  return change;
}

Result<query::TexelPatch> patch_of_keys(const RegionSource& target, const query::Pieces& pieces,
                                        const std::vector<std::int64_t>& keys,
                                        const Progress& progress) {
  auto values = target.values();
  for (std::uint32_t texel = 0; texel < pieces.of_texel.size(); ++texel)
    if (const std::uint32_t piece = pieces.of_texel[texel]; piece != query::kNoRegion)
      values.set(texel, {static_cast<std::uint32_t>(keys[piece]), true});
  return query::make_patch(target.tiles, target.layer.type, *target.map, std::move(values),
                           progress);
}

// Counts the pieces and their texels.
CleanupResult counted(const query::Pieces& pieces, double metres_per_unit) {
  CleanupResult result;
  result.regions = pieces.list.size();
  for (const query::Piece& piece : pieces.list) {
    result.texels += piece.texels;
    result.area_m2 += piece.area * metres_per_unit * metres_per_unit;
  }
  return result;
}

// An exception becomes an Error, because the caller must then delete the records.
Result<CleanupResult> paint_keys(const Services& services, room::Room& room,
                                 const RegionSource& target, const query::Pieces& pieces,
                                 const store::TableChange& change, const CleanupEdit& edit,
                                 Progress& progress) try {
  // Another user can have created records since the dry run.
  STRATA_TRY(check_keys_fit(change, target.layer));
  CleanupResult result;
  result.regions = pieces.list.size();
  result.keys = change.created;
  auto patch = STRATA_TRY(patch_of_keys(target, pieces, change.created, progress));
  return apply_patch(services, room, target, std::move(patch), std::move(result), edit, progress);
} catch (const std::exception& error) {
  log::error(std::string("the keys of new records could not be painted: ") + error.what());
  return fail(ErrorCode::internal, "Job failed",
              "An internal error stopped this job, for example because the server does not have "
              "enough memory. Ask an administrator to check the log of the server.");
}

// Deletes new records if they are certainly not painted and nobody has changed them. If the journal
// contains the edit that paints them, returns its result instead. After an Error, the records may
// remain, and their keys are retired.
Result<std::optional<CleanupResult>> delete_records(const Services& services, ModelId model,
                                                    const store::TableChange& change,
                                                    const CleanupEdit& edit) {
  const TableId table = change.table.id;
  // Before the checks, so that no edit can paint the keys afterwards.
  STRATA_TRY(services.rooms.retire_keys(table, change.created));
  STRATA_TRY(services.store.journal().wait_for_commits(model));
  auto saved = STRATA_TRY(find_saved(services, model, edit));
  if (saved && saved->keys == change.created) return saved;
  const auto painted = STRATA_TRY(painted_layers(services, table, Role::owner));
  // The text can name layers that the author does not see.
  if (!where_painted(painted, change.created).empty())
    return fail(ErrorCode::conflict, "Record has painted texels",
                "Other users have painted the keys of these records.");
  const auto undone =
      STRATA_TRY(services.store.tables().undo_entry(table, change.sequence, edit.author.user));
  services.changes.records_changed(undone, edit.author.user);
  return std::nullopt;
}

// Notifies others of the new records that still exist, and returns their keys.
Result<std::vector<std::int64_t>> announce(const Services& services,
                                           const store::TableChange& change,
                                           const std::string& user) {
  auto now = STRATA_TRY(
      services.store.tables().change_of(change.table.id, change.sequence, change.created.size()));
  services.rooms.admit_keys(now.table.id, now.created);
  services.changes.records_changed(now, user);
  return std::move(now.created);
}

// Names the records that could not be deleted. `left` is empty if it is not known which of them
// remain.
Error records_left(const Result<CleanupResult>& painted, const Error& why,
                   const store::TableChange& change, const std::vector<std::int64_t>& left) {
  const auto& keys = left.empty() ? change.created : left;
  return {why.code, "Records remain",
          (painted ? "" : painted.error().detail + " ") +
              "The server could not delete the new records of the table " + change.table.name +
              " (" + why.title + "). Records " + std::to_string(keys.front()) + " to " +
              std::to_string(keys.back()) + (left.empty() ? " may remain" : " remain") +
              ". To delete them, use Undo in the table."};
}

// Ends a job whose edit has failed, or has not painted the keys of the new records.
Result<CleanupResult> end_unpainted(const Services& services, ModelId model,
                                    const store::TableChange& change, const CleanupEdit& edit,
                                    Result<CleanupResult> painted) {
  auto saved = delete_records(services, model, change, edit);
  if (saved && !*saved) return painted;
  const auto left = announce(services, change, edit.author.user);
  if (saved) return std::move(**saved);
  if (left && left->empty()) return painted;  // only the confirmation of the undo was lost
  return tl::unexpected(
      records_left(painted, saved.error(), change, left.value_or(std::vector<std::int64_t>{})));
}

// If all texels of a piece were painted in the meantime, its record has none.
CleanupResult with_unpainted_keys(CleanupResult result, room::Room& room, const Layer& layer) {
  if (result.skipped_texels == 0) return result;
  const auto areas = room.queries().key_areas(to_string(layer.id));
  if (!areas) return result;
  for (const std::int64_t key : result.keys)
    if (!areas->contains(key)) result.unpainted_keys.push_back(key);
  return result;
}

}  // namespace

Result<CleanupResult> make_piece_records(const Services& services, room::Room& room,
                                         const Layer& layer, const PieceRecords& pieces,
                                         const CleanupEdit& edit, Progress& progress) {
  progress.report(0, "Reading the layers");
  const RegionSource source = STRATA_TRY(region_source(services, room, layer.id)),
                     target = STRATA_TRY(region_source(services, room, pieces.into));
  STRATA_TRY(check_target(source, target, edit));
  const auto found = STRATA_TRY(found_pieces(services, room, source, pieces, edit.apply, progress));
  if (!edit.apply || found.pieces.list.empty())
    return counted(found.pieces, source.metres_per_unit);

  progress.begin_stage(0.8, 1);
  progress.report(0, "Creating records");
  const std::string& user = edit.author.user;
  auto write = records_of(found, pieces, source.metres_per_unit);
  write.dry_run = true;
  const auto tried = STRATA_TRY(services.store.records().write(*target.layer.table, write, user));
  STRATA_TRY(check_written(tried));
  STRATA_TRY(check_keys_fit(tried, target.layer));
  if (progress.cancelled()) return cancelled_problem();
  write.dry_run = false;
  const auto change = STRATA_TRY(create_records(services, write, tried.table, user));
  auto painted = paint_keys(services, room, target, found.pieces, change, edit, progress);
  if (!painted || !painted->applied || painted->keys != change.created)
    return end_unpainted(services, room.model().id, change, edit, std::move(painted));
  if (const auto announced = announce(services, change, user); !announced)
    log::warning("users were not notified of new records: " + announced.error().detail);
  return with_unpainted_keys(std::move(*painted), room, target.layer);
}

}  // namespace strata::app
