#include "store/nodes/deposed.h"

namespace strata::store {

Result<std::optional<Error>> deposed_problem(PgConnection& connection, ModelId model,
                                             std::int64_t epoch) {
  auto rows = STRATA_TRY(connection.query(
      "SELECT m.owner_epoch, coalesce(n.url, '') FROM all_models m LEFT JOIN nodes n "
      "ON n.id = m.owner_node AND n.lease_until > clock_timestamp() WHERE m.id = $1",
      Params().id(model)));
  if (rows.rows() == 0 || rows.integer(0, 0) == epoch) return std::nullopt;
  return moved_to(rows.text(0, 1));
}

}  // namespace strata::store
