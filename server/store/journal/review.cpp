#include "store/journal/journal_reads.h"
#include "store/journal/merge_plan.h"
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
        // The first batch keeps its sequence when the batches of the stroke are merged.
        "SELECT w.stroke, w.first, w.last, w.user_name, e.op, w.begun, w.time, w.texels, w.area, e.record FROM "
        "(SELECT model_id, stroke, user_name, min(coalesce(first_sequence, sequence)) AS first, min(sequence) AS first_row, "
        "max(sequence) AS last, min(coalesce(first_time, time)) AS begun, "
        "max(time) AS time, sum((answer ->> 'texels_changed')::bigint)::bigint AS texels, "
        "sum((answer ->> 'area_m2')::double precision) AS area FROM edits WHERE layer_id = $1 AND review = 'pending' "
        "AND in_force AND ($2::text IS NULL OR user_name = $2) GROUP BY model_id, stroke, user_name "
        "HAVING min(coalesce(first_sequence, sequence)) > $5 ORDER BY min(coalesce(first_sequence, sequence)) LIMIT $3 OFFSET $4) w "
        "JOIN edits e ON e.model_id = w.model_id AND e.sequence = w.first_row ORDER BY w.first",
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

// Returns, for each named edit, the edit that contains it: itself, or the merged edit of its
// stroke. Strokes that are drawn at the same time overlap, so the query searches the batches.
constexpr const char* kNamed =
    "SELECT coalesce((SELECT e.sequence FROM edits e WHERE e.layer_id = $1 AND e.sequence > n.sequence "
    "AND e.sequence <= n.sequence + $3 AND e.first_sequence <= n.sequence AND EXISTS (SELECT 1 FROM edit_batches b "
    "WHERE b.layer_id = $1 AND b.edit = e.sequence AND b.sequence = n.sequence) ORDER BY e.sequence LIMIT 1), n.sequence) "
    "FROM unnest($2::bigint[]) WITH ORDINALITY AS n (sequence, place) ORDER BY n.place";

Result<UnderReview> Journal::under_review(LayerId layer_id, Decision decision,
                                          const Reviewees& which) {
  if (which.user) STRATA_TRY(check_text(*which.user, "user"));
  return pool_.read([&](PgConnection& connection) -> Result<UnderReview> {
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    UnderReview found;
    PgArray requested(oid::kInt8), named(oid::kInt8);
    for (const std::int64_t sequence : which.edits) requested.add(sequence);
    if (!which.edits.empty()) {
      auto rows = STRATA_TRY(connection.query(
          kNamed, Params().id(layer_id).array(requested).integer(MergeRules{}.max_span)));
      for (int i = 0; i < rows.rows(); ++i) {
        found.named.push_back(rows.integer(i, 0));
        named.add(found.named.back());
      }
    }
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
    for (int i = 0; i < rows.rows(); ++i)
      found.edits.push_back({rows.integer(i, 0), rows.uuid(i, 1), rows.text(i, 2)});
    return found;
  });
}

}  // namespace strata::store
