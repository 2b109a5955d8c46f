#include "store/nodes/nodes.h"
#include "store/pg/pg_row.h"
#include "store/store_impl.h"

namespace strata::store {

Result<Ownership> Nodes::ownership(int most) {
  return pool_.read([&](PgConnection& connection) -> Result<Ownership> {
    // The left join returns a row with the time even if no node has a model.
    auto rows = STRATA_TRY(connection.query(
        "SELECT t.now, o.owner_node, o.id, o.name, o.total FROM (SELECT clock_timestamp() AS now) t "
        "LEFT JOIN (SELECT owner_node, id, name, row_number() OVER (PARTITION BY owner_node ORDER BY id) AS place, "
        "count(*) OVER (PARTITION BY owner_node) AS total FROM models WHERE owner_node IS NOT NULL) o "
        "ON o.place <= $1 ORDER BY o.owner_node, o.id",
        Params().integer(most)));
    Ownership found;
    found.now = rows.time(0, 0);
    for (int i = 0; i < rows.rows() && !rows.null(i, 1); ++i) {
      PgRow row(rows, i);
      row.time();
      OwnedModels& owned = found.by_node[row.uuid()];
      owned.models.push_back({row.id<ModelId>(), row.text()});
      owned.total = row.integer();
    }
    return found;
  });
}

Result<std::optional<std::string>> Nodes::node_of_job(JobId job, const Uuid& self) {
  return pool_.read([&](PgConnection& connection) -> Result<std::optional<std::string>> {
    auto rows = STRATA_TRY(
        connection.query("SELECT n.url FROM jobs j JOIN nodes n ON n.id = j.node "
                         "WHERE j.id = $1 AND n.id <> $2 AND n.lease_until > clock_timestamp()",
                         Params().id(job).uuid(self)));
    return rows.rows() > 0 ? std::optional(rows.text(0, 0)) : std::nullopt;
  });
}

}  // namespace strata::store
