#include "store/cluster/schema_readers.h"

#include "store/nodes/nodes.h"

namespace strata::store {

Result<OlderPrograms> exclude_older_programs(PgConnection& connection, std::string_view migration,
                                             std::string_view version,
                                             std::chrono::milliseconds after_mark) {
  // A server without other nodes forgets no nodes, so their age is compared here, too.
  const auto others =
      STRATA_TRY(connection.query("SELECT EXISTS (SELECT 1 FROM nodes WHERE version <> $1 "
                                  "AND lease_until > clock_timestamp() - $2 * interval '1 hour')",
                                  Params().text(version).integer(Nodes::kForgetAfter.count())));
  if (others.boolean(0, 0)) return OlderPrograms::running;
  // Programs that start later read the mark. The database keeps its time, because another server
  // may have set it.
  STRATA_TRY(connection.query(
      "UPDATE schema_migrations SET readable_from = NULL, unreadable_since = clock_timestamp() "
      "WHERE version = $1 AND unreadable_since IS NULL",
      Params().text(migration)));
  const auto passed = STRATA_TRY(
      connection.query("SELECT EXISTS (SELECT 1 FROM schema_migrations WHERE version = $1 "
                       "AND unreadable_since <= clock_timestamp() - $2 * interval '1 millisecond')",
                       Params().text(migration).integer(after_mark.count())));
  return passed.boolean(0, 0) ? OlderPrograms::absent : OlderPrograms::excluded;
}

}  // namespace strata::store
