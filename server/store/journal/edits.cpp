#include "store/journal/journal_reads.h"
#include "store/journal/kept_states.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr auto kStateColumns =
    sql("e.time, e.in_force, e.review, r.user_name, r.record ->> 'reason', r.time FROM edits e "
        "LEFT JOIN edits r ON r.model_id = e.model_id AND r.sequence = e.reviewed_by ");
constexpr auto kEditColumns =
    sql("e.sequence, e.id, e.stroke, e.user_name, e.op, e.record, e.answer, ", kStateColumns);
// Lists do not need the paths of strokes, which can be thousands of points.
constexpr auto kListColumns = sql(
    "e.sequence, e.id, e.stroke, e.user_name, e.op, CASE WHEN jsonb_typeof(e.record) = 'object' "
    "THEN e.record - '{path,widths}'::text[] ELSE e.record END, e.answer, ",
    kStateColumns);

// The edits of model $1 with the ids $2. A batch of a merged edit keeps its response, and so does
// an edit in a checkpoint, which also keeps its author.
constexpr auto kWithIds = sql(
    "SELECT ", kEditColumns,
    "WHERE e.model_id = $1 AND e.id = any($2) AND e.first_sequence IS NULL UNION ALL "
    "SELECT b.sequence, b.id, e.stroke, coalesce(b.user_name, e.user_name), e.op, e.record, jsonb_strip_nulls(jsonb_build_object("
    "'sequence', b.sequence, 'texels_changed', b.texels_changed, 'area_m2', b.area_m2, "
    "'provisional', CASE WHEN b.provisional IS NULL THEN e.answer -> 'provisional' WHEN b.provisional THEN 'true' END)), ",
    kStateColumns,
    "JOIN edit_batches b ON b.model_id = e.model_id AND b.edit = e.sequence WHERE b.model_id = $1 AND b.id = any($2)");

// The state of model $1, and whether any of the ids $2 may be in its journal. Each edit waits for
// this query before it is painted, and its id is almost always new.
constexpr char kState[] =
    "SELECT m.sequence, m.owner_epoch, "
    "EXISTS (SELECT 1 FROM edits e WHERE e.model_id = m.id AND e.id = any($2)) "
    "OR EXISTS (SELECT 1 FROM edit_batches b WHERE b.model_id = m.id AND b.id = any($2)) "
    "FROM models m WHERE m.id = $1";

JournalRow read_row(const PgResult& rows, int i) {
  PgRow columns(rows, i);
  JournalRow row{columns.integer(), columns.uuid(), columns.uuid(),
                 columns.text(),    columns.text(), columns.json(),
                 columns.json(),    columns.time(), columns.boolean()};
  if (const auto review = columns.optional_text())
    row.review = parse_review(*review).value_or(Review::none);
  if (const auto reviewer = columns.optional_text()) {
    const auto reason = columns.optional_text();
    row.reviewer = {*reviewer, reason.value_or(""), columns.time()};
  }
  return row;
}

Result<std::vector<std::int64_t>> sequences(PgConnection& connection, const char* sql,
                                            const Params& params) {
  auto rows = STRATA_TRY(connection.query(sql, params));
  std::vector<std::int64_t> found;
  for (int i = 0; i < rows.rows(); ++i) found.push_back(rows.integer(i, 0));
  return found;
}

}  // namespace

Result<HistoryPage> Journal::history(LayerId layer_id, int limit, int offset,
                                     std::optional<std::int64_t> before) {
  return pool_.read([&](PgConnection& connection) -> Result<HistoryPage> {
    auto total = STRATA_TRY(connection.query(
        "SELECT (SELECT count(*) FROM edits WHERE layer_id = l.id) FROM layers l WHERE id = $1",
        Params().id(layer_id)));
    if (total.rows() == 0) return no_such("layer", to_string(layer_id));
    auto rows = STRATA_TRY(connection.query(
        sql("SELECT ", kListColumns,
            "WHERE e.layer_id = $1 AND e.sequence < $4 ORDER BY e.sequence DESC LIMIT $2 OFFSET $3"),
        Params()
            .id(layer_id)
            .integer(std::max(limit, 0))
            .integer(std::max(offset, 0))
            .integer(before.value_or(INT64_MAX))));
    HistoryPage page;
    page.total = total.integer(0, 0);
    for (int i = 0; i < rows.rows(); ++i) page.rows.push_back(read_row(rows, i));
    return page;
  });
}

Result<JournalState> Journal::state(ModelId model_id, std::span<const Uuid> ids) {
  PgArray requested(oid::kUuid);
  for (const Uuid& id : ids) requested.add(id);
  return pool_.read([&](PgConnection& connection) -> Result<JournalState> {
    auto model = connection.query(kState, Params().id(model_id).array(requested));
    if (!model) return tl::unexpected(model.error());
    if (model->rows() == 0) return no_such("model", to_string(model_id));
    JournalState state{model->integer(0, 0), model->integer(0, 1), {}};
    if (!model->boolean(0, 2)) return state;
    auto rows = connection.query(kWithIds, Params().id(model_id).array(requested));
    if (!rows) return tl::unexpected(rows.error());
    if (rows->rows() > 0) STRATA_TRY(connection.confirm_visible());
    for (int i = 0; i < rows->rows(); ++i) state.known.push_back(read_row(*rows, i));
    return state;
  });
}

Result<void> Journal::wait_for_commits(ModelId model_id) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    // Each transaction of the writer locks this row first.
    STRATA_TRY(connection.query("SELECT 1 FROM all_models WHERE id = $1 FOR SHARE",
                                Params().id(model_id)));
    return {};
  });
}

Result<std::vector<std::int64_t>> Journal::undoable(LayerId layer_id, const std::string& user,
                                                    bool pending_only) {
  STRATA_TRY(check_text(user, "user"));
  return pool_.read([&](PgConnection& connection) {
    return sequences(
        connection,
        "SELECT sequence FROM edits WHERE layer_id = $1 AND user_name = $2 AND writer AND in_force "
        "AND (NOT $3 OR review = 'pending') AND stroke = "
        "(SELECT stroke FROM edits WHERE layer_id = $1 AND user_name = $2 AND writer AND in_force "
        "AND (NOT $3 OR review = 'pending') ORDER BY sequence DESC LIMIT 1) ORDER BY sequence",
        Params().id(layer_id).text(user).boolean(pending_only));
  });
}

// Returns the batches that the newest undo disabled, unless a later edit of the user is in force.
// Strokes that a redo restored are older than the undo, so the order undo, undo, redo, redo works.
// Only a curator can restore rejected edits.
Result<std::vector<std::int64_t>> Journal::redoable(LayerId layer_id, const std::string& user,
                                                    bool pending_only) {
  STRATA_TRY(check_text(user, "user"));
  return pool_.read([&](PgConnection& connection) {
    return sequences(
        connection,
        "WITH undone AS (SELECT stroke, undone_by FROM edits WHERE layer_id = $1 AND user_name = $2 AND writer "
        "AND NOT in_force AND review IS DISTINCT FROM 'rejected' AND (NOT $3 OR review = 'pending') "
        "ORDER BY undone_by DESC, sequence DESC LIMIT 1) "
        "SELECT e.sequence FROM edits e JOIN undone u ON e.stroke = u.stroke AND e.undone_by = u.undone_by "
        "WHERE e.layer_id = $1 AND e.user_name = $2 AND e.writer AND NOT e.in_force AND NOT EXISTS "
        "(SELECT 1 FROM edits n WHERE n.layer_id = $1 AND n.user_name = $2 AND n.writer AND n.in_force "
        "AND n.sequence > u.undone_by) ORDER BY e.sequence",
        Params().id(layer_id).text(user).boolean(pending_only));
  });
}

Result<std::vector<std::int64_t>> Journal::undone_by(LayerId layer_id, const std::string& user,
                                                     std::int64_t undo) {
  return pool_.read([&](PgConnection& connection) {
    return sequences(connection,
                     "SELECT sequence FROM edits WHERE layer_id = $1 AND user_name = $2 "
                     "AND NOT in_force AND undone_by = $3 ORDER BY sequence",
                     Params().id(layer_id).text(user).integer(undo));
  });
}

Result<std::int64_t> Journal::sequence_at(ModelId model_id, const std::string& utc) {
  return pool_.read([&](PgConnection& connection) -> Result<std::int64_t> {
    // Clients get times in milliseconds. The state at the time of an edit must include the edit.
    // The planner does not know that an early time has a low sequence, and would search backward
    // through all later edits. So the query reads the index by time. Clocks can step back, so the
    // last edit by time need not have the highest sequence.
    auto row = STRATA_TRY(connection.query(
        "SELECT coalesce(max(sequence), 0) FROM (SELECT sequence FROM edits WHERE model_id = $1 "
        "AND time < date_trunc('milliseconds', $2::timestamptz) + interval '1 millisecond' ORDER BY time DESC LIMIT 1000) e",
        Params().id(model_id).text(utc)));
    // Within a checkpoint, the layer has the state before it.
    const auto kept = STRATA_TRY(kept_around(connection, model_id, row.integer(0, 0)));
    return kept ? kept->before : row.integer(0, 0);
  });
}

Result<std::optional<std::chrono::system_clock::time_point>> Journal::time_of_state(
    ModelId model_id, std::int64_t sequence) {
  return pool_.read([&](PgConnection& connection) -> Result<std::optional<Time>> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT e.time FROM edits e JOIN all_layers l ON l.id = e.layer_id "
        "WHERE e.model_id = $1 AND e.sequence <= $2 AND l.visibility = 'public' ORDER BY e.sequence DESC LIMIT 1",
        Params().id(model_id).integer(sequence)));
    return rows.rows() == 0 ? std::nullopt : std::optional(rows.time(0, 0));
  });
}

Result<std::int64_t> Journal::last_sequence(ModelId model_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::int64_t> {
    auto row = connection.query("SELECT sequence FROM models WHERE id = $1", Params().id(model_id));
    if (!row) return tl::unexpected(row.error());
    if (row->rows() == 0) return no_such("model", to_string(model_id));
    return row->integer(0, 0);
  });
}

Result<void> rename_in_journal(PgConnection& connection, const std::string& name,
                               const std::string& former) {
  constexpr auto kReasons = sql("UPDATE edits SET record = jsonb_set(record, '{reason}', to_jsonb(",
                                mention_renamed("record ->> 'reason'", "1000"),
                                ")) WHERE op IN ('accept', 'reject', 'reopen') AND ",
                                mentions_them("record ->> 'reason'"));
  for (
      const char* statement :
      {"UPDATE edits SET user_name = $2 WHERE user_name = $1",
       "UPDATE edit_batches SET user_name = $2 WHERE user_name = $1",
       // A checkpoint contains the authors of its edits.
       "UPDATE edits SET record = jsonb_set(record, '{people}', (SELECT jsonb_agg(CASE WHEN p ->> 'user' = $1 "
       "THEN jsonb_set(p, '{user}', to_jsonb($2::text)) ELSE p END) FROM jsonb_array_elements(record -> 'people') p)) "
       "WHERE op = 'checkpoint' AND record -> 'people' @> jsonb_build_array(jsonb_build_object('user', $1::text))",
       // Decisions of a review contain the author of the edits, and the reason as a text. Other
       // records are not searched, because they may be large.
       "UPDATE edits SET record = jsonb_set(record, '{user}', to_jsonb($2::text)) "
       "WHERE op IN ('accept', 'reject', 'reopen') AND record ->> 'user' = $1",
       kReasons.c_str()})
    STRATA_TRY(connection.query(statement, Params().text(name).text(former)));
  return {};
}

}  // namespace strata::store
