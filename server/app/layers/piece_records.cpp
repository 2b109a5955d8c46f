#include "app/layers/piece_records.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "app/change_notifier.h"
#include "core/log.h"
#include "mesh/parallel.h"
#include "query/regions/region_pieces.h"
#include "room/edit.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/table_changes.h"

namespace strata::app {
namespace {

// Checks that the keys of the pieces can be painted on a layer.
Result<void> check_target(const RegionSource& source, const RegionSource& target, Role role) {
  if (!target.layer.table)
    return fail(ErrorCode::invalid, "No table",
                target.layer.name + " is not a layer of records. Choose a layer of records.",
                "into");
  if (target.layer.id == source.layer.id)
    return fail(ErrorCode::invalid, "Same layer",
                "The pieces and their records need different layers. Choose another layer of "
                "records.",
                "into");
  if (target.layer.resolution != source.layer.resolution)
    return fail(ErrorCode::invalid, "Different resolutions",
                source.layer.name + " and " + target.layer.name +
                    " have different resolutions. Choose layers with the same resolution.",
                "into");
  if (source.layer.visibility > target.layer.visibility)
    return fail(ErrorCode::invalid, "Layer is hidden from some users",
                "Fewer users see " + source.layer.name + " than " + target.layer.name +
                    ". Choose a layer with the same visibility.",
                "into");
  return room::check_not_locked(target.layer, role);
}

store::WriteRecords records_of(const query::Pieces& pieces, const PieceRecords& request,
                               double metres_per_unit) {
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
    write.records.push_back(std::move(record));
  }
  return write;
}

Result<void> check_records(const store::TableChange& change, const Layer& target) {
  if (!change.problems.empty()) {
    Error problem = change.problems.front().problem;
    problem.detail = "The records cannot be created, so nothing was changed. " + problem.detail;
    return tl::unexpected(std::move(problem));
  }
  if (!change.created.empty() &&
      static_cast<double>(change.created.back()) > highest_value(target.type))
    return fail(ErrorCode::invalid, "Key too large",
                target.name + " can store keys up to " +
                    std::to_string(static_cast<std::int64_t>(highest_value(target.type))) +
                    ". Change the layer to a wider type first.",
                "into");
  return {};
}

void delete_again(const Services& services, TableId table, const std::vector<std::int64_t>& keys,
                  const std::string& user) {
  for (const std::int64_t key : keys) {
    const auto deleted = services.store.records().remove(table, key, {}, user);
    if (deleted) {
      services.changes.records_changed(*deleted, user);
    } else {
      log::warning(
          "record " + std::to_string(key) +
          " of pieces that were not painted could not be deleted: " + deleted.error().detail);
    }
  }
}

query::TexelPatch patch_of_keys(const RegionSource& target, const query::Pieces& pieces,
                                const std::vector<std::int64_t>& keys) {
  auto values = target.values();
  for (std::uint32_t texel = 0; texel < pieces.of_texel.size(); ++texel)
    if (const std::uint32_t piece = pieces.of_texel[texel]; piece != query::kNoRegion)
      values.set(texel, {static_cast<std::uint32_t>(keys[piece]), true});
  return query::make_patch(target.tiles, target.layer.type, *target.map, std::move(values));
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

}  // namespace

Result<CleanupResult> make_piece_records(const Services& services, room::Room& room,
                                         const Layer& layer, const PieceRecords& pieces,
                                         const CleanupEdit& edit, Progress& progress) {
  progress.report(0, "Reading the layers");
  const RegionSource source = STRATA_TRY(region_source(services, room, layer.id)),
                     target = STRATA_TRY(region_source(services, room, pieces.into));
  STRATA_TRY(check_target(source, target, edit.author.role));
  progress.begin_stage(0.05, 0.8);
  const double m2_per_unit2 = source.metres_per_unit * source.metres_per_unit;
  const auto found = STRATA_TRY(query::find_pieces(
      source.values(), {pieces.of_bits, pieces.min_area_m2 / m2_per_unit2, kMaxPieceRecords},
      *source.map, *source.graph, progress, mesh::background_threads()));
  if (!edit.apply || found.list.empty()) return counted(found, source.metres_per_unit);

  progress.begin_stage(0.8, 1);
  progress.report(0, "Creating records");
  const TableId table = *target.layer.table;
  const std::string& user = edit.author.user;
  auto write = records_of(found, pieces, source.metres_per_unit);
  write.dry_run = true;
  const auto tried = STRATA_TRY(services.store.records().write(table, write, user));
  STRATA_TRY(check_records(tried, target.layer));
  if (progress.cancelled()) return cancelled_problem();
  write.dry_run = false;
  const auto change = STRATA_TRY(services.store.records().write(table, write, user));
  services.changes.records_changed(change, user);
  if (auto fits = check_records(change, target.layer); !fits) {
    delete_again(services, table, change.created, user);
    return tl::unexpected(std::move(fits.error()));
  }

  auto painted = apply_patch(services, room, target, patch_of_keys(target, found, change.created),
                             edit, change.created, progress);
  // A repeated call has the answer of the first edit, whose records exist.
  const bool is_new = painted && painted->applied && !painted->repeated;
  if (!is_new) delete_again(services, table, change.created, user);
  if (!painted) return painted;
  painted->regions = found.list.size();
  if (is_new) painted->keys = change.created;
  return painted;
}

}  // namespace strata::app
