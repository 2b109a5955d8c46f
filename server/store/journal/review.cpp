#include "store/journal/journal_reads.h"
#include "store/pg/pg_row.h"
#include "store/store_impl.h"

namespace strata::store {

Result<ReviewQueue> Journal::review_queue(LayerId layer_id, const std::optional<std::string>& user,
                                          int limit, int offset, std::int64_t after) {
  if (user) STRATA_TRY(check_text(*user, "user"));
  return pool_.read([&](PgConnection& connection) -> Result<ReviewQueue> {
    auto people = STRATA_TRY(connection.query(
        "SELECT user_name, count(DISTINCT stroke) FROM edits WHERE layer_id = $1 AND review = 'pending' AND in_force "
        "GROUP BY user_name ORDER BY user_name",
        Params().id(layer_id)));
    ReviewQueue queue;
    for (int i = 0; i < people.rows(); ++i) {
      queue.people.push_back({people.text(i, 0), people.integer(i, 1)});
      if (!user || *user == queue.people.back().user) queue.total += queue.people.back().strokes;
    }
    auto rows = STRATA_TRY(connection.query(
        // The client of the author chooses the id of a stroke, so the same id from two users means
        // two strokes. Records contain whole paths and are read for one page only.
        "SELECT w.stroke, w.first, w.last, w.user_name, e.op, w.begun, w.time, w.texels, w.area, e.record FROM "
        "(SELECT model_id, stroke, user_name, min(sequence) AS first, max(sequence) AS last, min(time) AS begun, "
        "max(time) AS time, sum((answer ->> 'texels_changed')::bigint)::bigint AS texels, "
        "sum((answer ->> 'area_m2')::double precision) AS area FROM edits WHERE layer_id = $1 AND review = 'pending' "
        "AND in_force AND ($2::text IS NULL OR user_name = $2) GROUP BY model_id, stroke, user_name "
        "HAVING min(sequence) > $5 ORDER BY min(sequence) LIMIT $3 OFFSET $4) w "
        "JOIN edits e ON e.model_id = w.model_id AND e.sequence = w.first ORDER BY w.first",
        Params()
            .id(layer_id)
            .optional_text(user)
            .integer(std::max(limit, 0))
            .integer(std::max(offset, 0))
            .integer(after)));
    for (int i = 0; i < rows.rows(); ++i) {
      PgRow row(rows, i);
      queue.strokes.push_back({row.uuid(), row.integer(), row.integer(), row.text(), row.text(),
                               row.time(), row.time(), static_cast<std::uint64_t>(row.integer()),
                               row.real(), row.json()});
    }
    return queue;
  });
}

Result<std::vector<UnderReview>> Journal::under_review(LayerId layer_id, Decision decision,
                                                       const Reviewees& which) {
  if (which.user) STRATA_TRY(check_text(*which.user, "user"));
  PgArray named(oid::kInt8);
  for (const std::int64_t sequence : which.edits) named.add(sequence);
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<UnderReview>> {
    const std::string sql =
        std::string("SELECT sequence, stroke, user_name FROM edits WHERE layer_id = $1 AND ") +
        (decision == Decision::reopen
             ? "((review = 'accepted' AND in_force) OR review = 'rejected')"
             : "review = 'pending' AND in_force") +
        // Includes the batches of the same stroke with the same decision: if parts of a stroke were
        // decided separately, only one decision is selected.
        " AND ($2::text IS NULL OR user_name = $2) AND (cardinality($3) = 0 OR "
        "(stroke, user_name, coalesce(reviewed_by, 0)) IN (SELECT stroke, user_name, coalesce(reviewed_by, 0) "
        "FROM edits WHERE layer_id = $1 AND sequence = any($3))) ORDER BY sequence";
    auto rows = STRATA_TRY(connection.query(
        sql.c_str(), Params().id(layer_id).optional_text(which.user).array(named)));
    std::vector<UnderReview> found;
    for (int i = 0; i < rows.rows(); ++i)
      found.push_back({rows.integer(i, 0), rows.uuid(i, 1), rows.text(i, 2)});
    return found;
  });
}

}  // namespace strata::store
