#include "store/content/trash.h"

#include "store/pg/blobs.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"
#include "store/tables/table_writer.h"

namespace strata::store {
namespace {

using Kind = TrashEntry::Kind;

constexpr int kRowsAtOnce = 2000;

// The content of the Trash of project $1. If $3 is true (for curators): its models, and layers of
// models that are not in the Trash, with one of the visibilities $2. Also the records that were
// deleted in the last $4 days and not created again.
constexpr auto kTrash = sql(
    "(SELECT 'layer' AS kind, l.id, l.name, l.model_id, m.name AS model_name, 0::bigint AS table_id, '' AS table_name, "
    "l.binned_by, l.binned, l.binned_bytes FROM all_layers l JOIN models m ON m.id = l.model_id WHERE m.project_id = $1 "
    "AND l.binned IS NOT NULL AND NOT l.erasing AND l.visibility = any($2) AND $3 UNION ALL "
    "SELECT 'model', id, name, id, '', 0, '', binned_by, binned, binned_bytes FROM all_models "
    "WHERE project_id = $1 AND binned IS NOT NULL AND NOT erasing AND $3 UNION ALL "
    "SELECT 'record', c.subject_id, coalesce(nullif((SELECT c.before ->> r.id::text FROM record_columns r "
    "WHERE r.table_id = c.table_id AND r.kind = 'text' AND NOT r.hidden AND r.visibility = any($2) "
    "ORDER BY (r.properties ->> 'order')::integer, r.id LIMIT 1), ''), c.subject_id::text), 0, '', t.id, t.name, "
    "e.user_name, e.time, 0 FROM record_tables t JOIN table_edits e ON e.table_id = t.id "
    "JOIN table_changes c ON c.table_id = t.id AND c.sequence = e.sequence WHERE t.project_id = $1 "
    "AND e.time > clock_timestamp() - $4 * interval '1 day' AND e.op IN ('delete', 'redo') AND c.subject = 'record' "
    "AND c.after -> 'exists' = 'false' AND NOT EXISTS (SELECT 1 FROM table_changes n WHERE n.table_id = c.table_id "
    "AND n.subject = 'record' AND n.subject_id = c.subject_id AND n.sequence > c.sequence AND n.after ? 'exists')) bin ");

Params seen_in(ProjectId project_id, const Trash::Sight& sight) {
  Params params;
  params.id(project_id)
      .array(visibilities_seen_by(sight.role))
      .boolean(sight.role >= Role::curator)
      .integer(sight.role >= Role::annotator ? sight.records.count() : 0);
  return params;
}

TrashEntry read_entry(const PgResult& rows, int i) {
  PgRow row(rows, i);
  TrashEntry entry;
  const std::string kind = row.text();
  entry.kind = kind == "layer" ? Kind::layer : kind == "model" ? Kind::model : Kind::record;
  entry.id = row.integer();
  entry.name = row.text();
  entry.model_id = row.id<ModelId>();
  entry.model_name = row.text();
  entry.table_id = row.id<TableId>();
  entry.table_name = row.text();
  entry.user = row.text();
  entry.deleted = row.time();
  entry.bytes = static_cast<std::uint64_t>(row.integer());
  return entry;
}

const char* name_of(Kind kind) {
  return kind == Kind::layer ? "layer" : kind == Kind::model ? "model" : "record";
}

tl::unexpected<Error> not_in_trash(const TrashEntry& entry) {
  return fail(ErrorCode::not_found, "Not in the Trash",
              "The " + std::string(name_of(entry.kind)) + " " + entry.name +
                  " is no longer in the Trash: somebody restored or erased it.");
}

// Returns success if one row was changed. Otherwise returns the error that `id` does not exist.
Result<void> changed_one(const Result<PgResult>& done, Kind kind, std::int64_t id) {
  if (!done) return tl::unexpected(done.error());
  return done->affected() > 0 ? Result<void>{} : no_such(name_of(kind), std::to_string(id));
}

}  // namespace

Result<void> erase_layer(PgConnection& connection, LayerId id) {
  // Comments about the layer keep its visibility, so that they are not visible to more users than
  // before.
  STRATA_TRY(connection.query(
      "UPDATE comments c SET visibility = l.visibility FROM all_layers l WHERE l.id = $1 AND c.layer_id = l.id",
      Params().id(id)));
  auto done = connection.query("DELETE FROM all_layers WHERE id = $1", Params().id(id));
  return done ? Result<void>{} : tl::unexpected(done.error());
}

// The blobs of model $1.
constexpr auto kBlobsOfModel = sql(
    "SELECT geometry FROM all_models WHERE id = $1 UNION "
    "SELECT sha256 FROM model_sources WHERE model_id = $1 UNION SELECT picture FROM looks WHERE model_id = $1 UNION "
    "SELECT geometry FROM detail_levels WHERE model_id = $1 UNION "
    "SELECT f.sha256 FROM tour_files f JOIN tours t ON t.id = f.tour_id WHERE t.model_id = $1 UNION "
    "SELECT sha256 FROM photographs WHERE model_id = $1 AND sha256 IS NOT NULL");

Result<void> erase_model(PgConnection& connection, ModelId id) {
  auto used = STRATA_TRY(connection.query(kBlobsOfModel, Params().id(id)));
  std::vector<std::vector<std::uint8_t>> hashes;
  for (int i = 0; i < used.rows(); ++i) {
    const Bytes hash = used.bytes(i, 0);
    hashes.emplace_back(hash.begin(), hash.end());
  }
  STRATA_TRY(connection.query("DELETE FROM all_models WHERE id = $1", Params().id(id)));
  return drop_unused(connection, hashes);
}

Result<Trash::Page> Trash::of_project(ProjectId project_id, const Sight& sight, int limit,
                                      int offset, const std::optional<Place>& after) {
  return pool_.read([&](PgConnection& connection) -> Result<Page> {
    auto total = STRATA_TRY(
        connection.query(sql("SELECT count(*) FROM ", kTrash), seen_in(project_id, sight)));
    const Place place = after.value_or(Place{});
    auto rows = STRATA_TRY(connection.query(
        sql("SELECT * FROM ", kTrash,
            "CROSS JOIN (SELECT timestamptz 'epoch' + $7::bigint * interval '1 microsecond' AS time) place "
            "WHERE NOT $8 OR binned < place.time OR (binned = place.time AND (kind, table_id, id) > ($9, $10::bigint, $11::bigint)) "
            "ORDER BY binned DESC, kind, table_id, id LIMIT $5 OFFSET $6"),
        seen_in(project_id, sight)
            .integer(limit)
            .integer(offset)
            .integer(place.deleted_us)
            .boolean(after.has_value())
            .text(name_of(place.kind))
            .id(place.table_id)
            .integer(place.id)));
    Page page;
    page.total = total.integer(0, 0);
    for (int i = 0; i < rows.rows(); ++i) page.entries.push_back(read_entry(rows, i));
    return page;
  });
}

Result<TrashEntry> Trash::entry(ProjectId project_id, Kind kind, std::int64_t id, TableId table_id,
                                const Sight& sight) {
  return pool_.read([&](PgConnection& connection) -> Result<TrashEntry> {
    auto rows = STRATA_TRY(connection.query(
        sql("SELECT * FROM ", kTrash, "WHERE kind = $5 AND id = $6 AND table_id = $7"),
        seen_in(project_id, sight).text(name_of(kind)).integer(id).id(table_id)));
    if (rows.rows() == 0)
      return fail(ErrorCode::not_found, "Not in the Trash",
                  "The project's Trash does not contain the " + std::string(name_of(kind)) +
                      " with the id " + std::to_string(id) + ".");
    return read_entry(rows, 0);
  });
}

Result<void> Trash::put_layer(LayerId id, const IdempotentResponse<>& answer) {
  const auto work = [&](PgConnection& connection) {
    return changed_one(
        connection.query(
            "UPDATE all_layers SET binned = clock_timestamp(), binned_by = activity_author(), binned_bytes = "
            "(SELECT coalesce(sum(octet_length(difference) + coalesce(octet_length(key_tile), 0)), 0) FROM tile_revisions "
            "WHERE layer_id = $1) + (SELECT coalesce(sum(octet_length(content)), 0) FROM tile_segments WHERE layer_id = $1) WHERE id = (SELECT id FROM layers WHERE id = $1) AND binned IS NULL",
            Params().id(id)),
        Kind::layer, id.number());
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<void> Trash::put_model(ModelId id, const IdempotentResponse<>& answer) {
  const auto work = [&](PgConnection& connection) {
    return changed_one(
        connection.query(
            sql("UPDATE all_models SET binned = clock_timestamp(), binned_by = activity_author(), binned_bytes = "
                "(SELECT coalesce(sum(octet_length(r.difference) + coalesce(octet_length(r.key_tile), 0)), 0) "
                "FROM tile_revisions r JOIN all_layers l ON l.id = r.layer_id WHERE l.model_id = $1) + "
                "(SELECT coalesce(sum(octet_length(s.content)), 0) FROM tile_segments s JOIN all_layers l ON l.id = s.layer_id "
                "WHERE l.model_id = $1) + "
                "(SELECT coalesce(sum(b.bytes), 0) FROM blobs b WHERE b.sha256 IN "
                "(",
                kBlobsOfModel, ")) WHERE id = $1 AND binned IS NULL"),
            Params().id(id)),
        Kind::model, id.number());
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<TrashRestored> Trash::restore(const TrashEntry& entry,
                                     const IdempotentResponse<TrashRestored>& answer) {
  const bool is_layer = entry.kind == Kind::layer;
  return change(pool_, answer, [&](PgConnection& connection) -> Result<TrashRestored> {
    // Lock the model of a layer first. Until the commit, the model must not be moved to the Trash,
    // or get a layer with this slug.
    if (is_layer) {
      auto model = STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1 FOR UPDATE",
                                               Params().id(entry.model_id)));
      if (model.rows() == 0) return not_in_trash(entry);
    }
    auto known = STRATA_TRY(connection.query(
        is_layer
            ? "SELECT slug::text FROM all_layers WHERE id = $1 AND binned IS NOT NULL AND NOT erasing FOR UPDATE"
            : "SELECT slug::text FROM all_models WHERE id = $1 AND binned IS NOT NULL AND NOT erasing FOR UPDATE",
        Params().integer(entry.id)));
    if (known.rows() == 0) return not_in_trash(entry);
    const std::string former = known.text(0, 0);
    auto taken =
        is_layer
            ? connection.query("SELECT slug::text FROM layers WHERE slug LIKE $1 AND model_id = $2",
                               Params().text(former + "%").id(entry.model_id))
            : connection.query("SELECT slug::text FROM models WHERE slug LIKE $1",
                               Params().text(former + "%"));
    if (!taken) return tl::unexpected(taken.error());
    TrashRestored restored{entry, free_slug(former, *taken), {}};
    if (restored.slug != former) {
      restored.former_slug = former;
      STRATA_TRY(connection.query(is_layer ? "UPDATE all_layers SET slug = $2 WHERE id = $1"
                                           : "UPDATE all_models SET slug = $2 WHERE id = $1",
                                  Params().integer(entry.id).text(restored.slug)));
    }
    STRATA_TRY(connection.query(
        is_layer
            ? "UPDATE all_layers SET binned = NULL, binned_by = NULL, binned_bytes = NULL, version = version + 1 WHERE id = $1"
            : "UPDATE all_models SET binned = NULL, binned_by = NULL, binned_bytes = NULL, version = version + 1 WHERE id = $1",
        Params().integer(entry.id)));
    return restored;
  });
}

Result<TableChange> Trash::restore_record(const TrashEntry& entry, const std::string& user,
                                          const IdempotentResponse<TableChange>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<TableChange> {
    auto open = STRATA_TRY(lock_table(connection, entry.table_id));
    auto last = STRATA_TRY(connection.query(
        "SELECT before FROM table_changes WHERE table_id = $1 AND subject = 'record' AND subject_id = $2 "
        "AND after ? 'exists' ORDER BY sequence DESC LIMIT 1",
        Params().id(entry.table_id).integer(entry.id)));
    if (last.rows() == 0 || !last.json(0, 0).value("exists", false)) return not_in_trash(entry);
    const nlohmann::json before = last.json(0, 0);
    TableEdit edit{user, "restore", {{"records", 1}, {"keys", nlohmann::json::array({entry.id})}},
                   {},   {},        true};
    Cells& cells = edit.records[entry.id];
    cells["exists"] = true;
    for (const Column& column : open.all)
      if (const auto cell = before.find(to_string(column.id)); cell != before.end())
        cells[cell.key()] = *cell;
    auto done = apply_edit(connection, open, std::move(edit));
    if (done && !done->problems.empty())
      return fail(ErrorCode::conflict, "Cannot restore", done->problems.front().problem.detail);
    return done;
  });
}

Result<void> Trash::erase(const TrashEntry& entry, const IdempotentResponse<>& answer) {
  if (entry.kind == Kind::record)
    return fail(ErrorCode::conflict, "Records cannot be erased",
                "The history of the table keeps the values of deleted records, so they cannot "
                "be erased.");
  return change(pool_, answer, [&](PgConnection& connection) -> Result<void> {
    auto done = STRATA_TRY(connection.query(
        entry.kind == Kind::layer
            ? "UPDATE all_layers SET erasing = true WHERE id = $1 AND binned IS NOT NULL AND NOT erasing"
            : "UPDATE all_models SET erasing = true WHERE id = $1 AND binned IS NOT NULL AND NOT erasing",
        Params().integer(entry.id)));
    return done.affected() > 0 ? Result<void>{} : not_in_trash(entry);
  });
}

Result<void> Trash::expire(std::chrono::days after) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    for (
        const char* sql :
        {"UPDATE all_layers SET erasing = true WHERE NOT erasing AND binned <= clock_timestamp() - $1 * interval '1 day'",
         "UPDATE all_models SET erasing = true WHERE NOT erasing AND binned <= clock_timestamp() - $1 * interval '1 day'"})
      STRATA_TRY(connection.query(sql, Params().integer(after.count())));
    return {};
  });
}

Result<bool> Trash::erase_some() {
  return pool_.write_within(kBulkLimits, [&](PgConnection& connection) -> Result<bool> {
    auto layer = STRATA_TRY(connection.query(
        "SELECT l.id FROM all_layers l JOIN all_models m ON m.id = l.model_id WHERE l.erasing OR m.erasing ORDER BY l.id LIMIT 1"));
    if (layer.rows() > 0) {
      const LayerId id = layer.id<LayerId>(0, 0);
      for (
          const char* sql :
          {"DELETE FROM tile_revisions WHERE ctid = any(ARRAY(SELECT ctid FROM tile_revisions WHERE layer_id = $1 LIMIT $2))",
           "DELETE FROM tile_segments WHERE ctid = any(ARRAY(SELECT ctid FROM tile_segments WHERE layer_id = $1 LIMIT $2))",
           "DELETE FROM edit_batches WHERE ctid = any(ARRAY(SELECT ctid FROM edit_batches WHERE layer_id = $1 LIMIT $2))",
           "DELETE FROM edits WHERE ctid = any(ARRAY(SELECT ctid FROM edits WHERE layer_id = $1 LIMIT $2))"}) {
        auto some = STRATA_TRY(connection.query(sql, Params().id(id).integer(kRowsAtOnce)));
        if (some.affected() > 0) return true;
      }
      STRATA_TRY(erase_layer(connection, id));
      return true;
    }
    auto model =
        STRATA_TRY(connection.query("SELECT id FROM all_models WHERE erasing ORDER BY id LIMIT 1"));
    if (model.rows() == 0) return false;
    STRATA_TRY(erase_model(connection, model.id<ModelId>(0, 0)));
    return true;
  });
}

}  // namespace strata::store
