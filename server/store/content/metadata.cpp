#include "store/content/metadata.h"

#include "store/pg/pg_row.h"
#include "store/store_impl.h"

namespace strata::store {

Result<StoredMetadata> Metadata::of_project(ProjectId project_id) {
  return pool_.read([&](PgConnection& connection) -> Result<StoredMetadata> {
    const auto rows = STRATA_TRY(
        connection.query("SELECT record, version FROM project_metadata WHERE project_id = $1",
                         Params().id(project_id)));
    if (rows.rows() == 0) return StoredMetadata{};
    PgRow row(rows, 0);
    StoredMetadata stored;
    stored.record = row.json();
    stored.version = row.integer();
    return stored;
  });
}

Result<StoredMetadata> Metadata::replace(ProjectId project_id, const nlohmann::json& record,
                                         std::int64_t version,
                                         const IdempotentResponse<StoredMetadata>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<StoredMetadata> {
    STRATA_TRY(lock_project(connection, project_id));
    const auto rows = STRATA_TRY(connection.query(
        "INSERT INTO project_metadata AS m (project_id, record) SELECT $1, $2 WHERE $3 = 0 "
        "OR EXISTS (SELECT 1 FROM project_metadata WHERE project_id = $1) "
        "ON CONFLICT (project_id) DO UPDATE SET record = excluded.record, version = m.version + 1 "
        "WHERE m.version = $3 RETURNING version",
        Params().id(project_id).json(record).integer(version)));
    if (rows.rows() == 0) return stale("metadata");
    return StoredMetadata{record, rows.integer(0, 0)};
  });
}

}  // namespace strata::store
