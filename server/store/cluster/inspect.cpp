#include "store/cluster/inspect.h"

#include "store/cluster/migrations.h"

namespace strata::store {

Result<std::int64_t> newest_migration(const std::filesystem::path& migrations_dir) {
  auto known = STRATA_TRY(read_migrations(migrations_dir));
  return std::stoll(known.back().version);
}

Result<DatabaseState> inspect_database(const std::string& dsn,
                                       const std::filesystem::path& migrations_dir) {
  const auto known = STRATA_TRY(newest_migration(migrations_dir));
  auto connection = STRATA_TRY(PgConnection::connect(dsn));
  STRATA_TRY(connection.script("SET default_transaction_read_only = on"));
  auto row = STRATA_TRY(connection.query(
      "SELECT current_setting('server_version'), current_setting('server_encoding'), "
      "pg_database_size(current_database()), to_regclass('schema_migrations') IS NOT NULL"));
  DatabaseState state{row.text(0, 0), row.text(0, 1), 0, known,
                      static_cast<std::uint64_t>(row.integer(0, 2))};
  if (!row.boolean(0, 3)) return state;
  auto applied =
      connection.query("SELECT coalesce(max(version::bigint), 0) FROM schema_migrations");
  if (!applied) return tl::unexpected(applied.error());
  state.schema_version = applied->integer(0, 0);
  return state;
}

}  // namespace strata::store
