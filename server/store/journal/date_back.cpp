#include "store/journal/journal_writer.h"
#include "store/store_impl.h"

namespace strata::store {

Result<std::chrono::system_clock::time_point> JournalWriter::date_back(
    Store& store, ProjectId project, std::chrono::system_clock::time_point since,
    std::chrono::system_clock::time_point time) {
  static constexpr const char* kUpdates[] = {
      "UPDATE comments c SET resolved = $3, changed = $3 FROM all_models m "
      "WHERE m.id = c.model_id AND m.project_id = $1 AND c.resolved >= $2",
      "UPDATE comments c SET time = $3, changed = $3 FROM all_models m "
      "WHERE m.id = c.model_id AND m.project_id = $1 AND c.time >= $2",
      "UPDATE table_edits e SET time = $3 FROM record_tables t "
      "WHERE t.id = e.table_id AND t.project_id = $1 AND e.time >= $2",
      "UPDATE attachments a SET time = $3 FROM record_tables t "
      "WHERE t.id = a.table_id AND t.project_id = $1 AND a.time >= $2",
      "UPDATE views v SET time = $3 FROM all_models m "
      "WHERE m.id = v.model_id AND m.project_id = $1 AND v.time >= $2",
      "UPDATE snapshots s SET time = $3 FROM all_models m "
      "WHERE m.id = s.model_id AND m.project_id = $1 AND s.time >= $2",
      "UPDATE kiosks k SET created = $3 FROM tours o JOIN all_models m ON m.id = o.model_id "
      "WHERE o.id = k.tour_id AND m.project_id = $1 AND k.created >= $2",
      "UPDATE tours o SET time = $3 FROM all_models m "
      "WHERE m.id = o.model_id AND m.project_id = $1 AND o.time >= $2",
      "UPDATE activities SET begun = $3, time = $3 WHERE project_id = $1 AND time >= $2"};
  return store.impl_->pool.write(
      [&](PgConnection& connection) -> Result<std::chrono::system_clock::time_point> {
        for (const char* sql : kUpdates)
          STRATA_TRY(connection.query(sql, Params().id(project).time(since).time(time)));
        const auto now = STRATA_TRY(connection.query("SELECT clock_timestamp()"));
        return now.time(0, 0);
      });
}

}  // namespace strata::store
