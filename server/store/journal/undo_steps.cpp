#include "store/journal/undo_steps.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "store/journal/journal_reads.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

// Returns the number of journal rows that are read for a list of `limit` steps. A stroke has a row
// for each batch, and a long stroke has hundreds.
constexpr int most_rows_of(int limit) { return limit * 8 + 500; }

constexpr auto kLayers = sql(
    "WITH l AS (SELECT id, id = any($2) AS pending FROM unnest($1::bigint[]) AS id) "
    "SELECT coalesce(e.first_sequence, e.sequence), e.sequence, e.stroke, l.id, e.op, e.time, (e.answer ->> 'texels_changed')::bigint, "
    "(e.answer ->> 'area_m2')::double precision, coalesce(e.undone_by, 0) FROM l CROSS JOIN LATERAL ");

// The rules are the same as in `Journal::undoable` and `Journal::redoable`.
constexpr auto kDone =
    sql(kLayers,
        "(SELECT * FROM edits WHERE layer_id = l.id AND user_name = $3 AND writer AND in_force "
        "AND (NOT l.pending OR review = 'pending') ORDER BY sequence DESC LIMIT $4) e "
        "ORDER BY e.sequence DESC LIMIT $4");
constexpr auto kUndone = sql(
    kLayers,
    "(SELECT coalesce(max(sequence), 0) AS newest FROM edits WHERE layer_id = l.id AND user_name = $3 AND writer AND in_force) n "
    "CROSS JOIN LATERAL (SELECT * FROM edits WHERE layer_id = l.id AND user_name = $3 AND writer AND NOT in_force "
    "AND undone_by > n.newest AND review IS DISTINCT FROM 'rejected' AND (NOT l.pending OR review = 'pending') "
    "ORDER BY undone_by DESC, sequence DESC LIMIT $4) e ORDER BY e.undone_by DESC, e.sequence DESC LIMIT $4");

struct Row {
  UndoStep step;
  std::int64_t undone_by = 0;
};

// Joins the batches of each stroke, in the order of the rows.
Result<std::vector<Row>> steps_of(PgConnection& connection, const char* statement,
                                  const Params& params, int most_rows, bool& is_cut) {
  auto rows = STRATA_TRY(connection.query(statement, params));
  is_cut = rows.rows() >= most_rows;
  std::vector<Row> found;
  std::map<std::tuple<LayerId, Uuid, std::int64_t>, std::size_t> of_stroke;
  std::size_t last = 0;  // index of the step of the last row
  for (int i = 0; i < rows.rows(); ++i) {
    PgRow columns(rows, i);
    Row row;
    row.step.first = columns.integer();
    row.step.last = columns.integer();
    row.step.stroke = columns.uuid();
    row.step.layer = LayerId(columns.integer());
    row.step.op = columns.text();
    row.step.time = columns.time();
    row.step.texels = static_cast<std::uint64_t>(columns.optional_integer().value_or(0));
    row.step.area_m2 = columns.optional_real().value_or(0);
    row.undone_by = columns.integer();
    const auto [known, is_new] =
        of_stroke.try_emplace({row.step.layer, row.step.stroke, row.undone_by}, found.size());
    last = known->second;
    if (is_new) {
      found.push_back(std::move(row));
      continue;
    }
    UndoStep& step = found[known->second].step;
    step.first = std::min(step.first, row.step.first);
    step.texels += row.step.texels;
    step.area_m2 += row.step.area_m2;
  }
  // The last step may lack rows that were not read.
  if (is_cut && found.size() > 1) found.erase(found.begin() + static_cast<std::ptrdiff_t>(last));
  return found;
}

// Removes the steps that no redo can reach because an earlier step is redone first.
std::vector<Row> redos_in_order(std::vector<Row> rows) {
  std::map<LayerId, std::int64_t> newest;  // newest sequence in force after the previous redos
  std::map<LayerId, bool> ended;
  std::erase_if(rows, [&](const Row& row) {
    bool& has_ended = ended[row.step.layer];
    std::int64_t& last = newest[row.step.layer];
    has_ended = has_ended || last > row.undone_by;
    last = std::max(last, row.step.last);
    return has_ended;
  });
  return rows;
}

// Adds the values to the steps. The record of each batch contains the value.
Result<void> add_values(PgConnection& connection, ModelId model_id, std::vector<UndoStep>& steps) {
  PgArray sequences(oid::kInt8);
  std::map<std::int64_t, UndoStep*> of_sequence;
  for (UndoStep& step : steps) {
    sequences.add(step.last);
    of_sequence[step.last] = &step;
  }
  auto rows = STRATA_TRY(connection.query(
      "SELECT sequence, CASE WHEN op IN ('stroke', 'fill', 'polygon') THEN (record ->> 'value')::double precision END, "
      "coalesce((record ->> 'erase')::boolean, false) FROM edits WHERE model_id = $1 AND sequence = any($2)",
      Params().id(model_id).array(sequences)));
  for (int i = 0; i < rows.rows(); ++i) {
    PgRow columns(rows, i);
    UndoStep& step = *of_sequence.at(columns.integer());
    step.value = columns.optional_real();
    step.erases = columns.boolean();
    if (step.erases) step.value.reset();
  }
  return {};
}

std::vector<UndoStep> first_of(std::vector<Row> rows, int limit) {
  std::vector<UndoStep> steps;
  for (Row& row : rows) {
    if (static_cast<int>(steps.size()) == limit) break;
    steps.push_back(std::move(row.step));
  }
  return steps;
}

}  // namespace

Result<UndoSteps> Journal::undo_steps(ModelId model_id, const std::string& user,
                                      const UndoQuery& query) {
  STRATA_TRY(check_text(user, "user"));
  PgArray layers(oid::kInt8), pending(oid::kInt8);
  for (const LayerId id : query.layers) layers.add(id);
  for (const LayerId id : query.pending_only) pending.add(id);
  return pool_.read([&](PgConnection& connection) -> Result<UndoSteps> {
    Params params;
    const int most_rows = most_rows_of(query.limit);
    params.array(layers).array(pending).text(user).integer(most_rows);
    UndoSteps steps;
    bool done_cut = false, undone_cut = false;
    auto done = STRATA_TRY(steps_of(connection, kDone.c_str(), params, most_rows, done_cut));
    auto undone = STRATA_TRY(steps_of(connection, kUndone.c_str(), params, most_rows, undone_cut));
    steps.more = done_cut || static_cast<int>(done.size()) > query.limit;
    steps.done = first_of(std::move(done), query.limit);
    steps.undone = first_of(redos_in_order(std::move(undone)), query.limit);
    STRATA_TRY(add_values(connection, model_id, steps.done));
    STRATA_TRY(add_values(connection, model_id, steps.undone));
    return steps;
  });
}

}  // namespace strata::store
