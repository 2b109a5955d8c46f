#include "store/cluster/schema_readers.h"

namespace strata::store {

Result<OlderPrograms> exclude_older_programs(PgConnection& connection, std::string_view migration,
                                             std::string_view version) {
  const auto others = STRATA_TRY(connection.query(
      "SELECT EXISTS (SELECT 1 FROM nodes WHERE lease_until > clock_timestamp() AND version <> $1)",
      Params().text(version)));
  if (others.boolean(0, 0)) return OlderPrograms::running;
  const auto marked =
      STRATA_TRY(connection.query("UPDATE schema_migrations SET readable_from = NULL "
                                  "WHERE version = $1 AND readable_from IS NOT NULL",
                                  Params().text(migration)));
  return marked.affected() > 0 ? OlderPrograms::excluded : OlderPrograms::absent;
}

}  // namespace strata::store
