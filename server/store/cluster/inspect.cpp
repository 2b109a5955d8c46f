#include "store/cluster/inspect.h"

#include "store/cluster/migrations.h"

namespace strata::store {

Result<std::int64_t> newest_migration(const std::filesystem::path& migrations_dir) {
  auto known = STRATA_TRY(read_migrations(migrations_dir));
  return known.back().number;
}

std::string newer_version_advice(const std::string& applied_by) {
  return applied_by.empty()
             ? "Start the version of Strata that updated it, or a later version."
             : "Start Strata " + applied_by + ", which updated it, or a later version.";
}

Result<DatabaseState> inspect_database(const std::string& dsn,
                                       const std::filesystem::path& migrations_dir) {
  const auto known = STRATA_TRY(read_migrations(migrations_dir));
  auto connection = STRATA_TRY(PgConnection::connect(dsn));
  STRATA_TRY(connection.script("SET default_transaction_read_only = on"));
  auto row = STRATA_TRY(connection.query(
      "SELECT current_setting('server_version'), current_setting('server_encoding'), "
      "pg_database_size(current_database()), to_regclass('schema_migrations') IS NOT NULL"));
  DatabaseState state;
  state.server_version = row.text(0, 0);
  state.encoding = row.text(0, 1);
  state.known_version = known.back().number;
  state.bytes = static_cast<std::uint64_t>(row.integer(0, 2));
  if (!row.boolean(0, 3)) return state;
  auto schema = STRATA_TRY(read_schema(connection));
  state.schema_version = schema.version();
  state.readable_from = schema.readable_from();
  state.applied_by = schema.applied_by;
  for (const Migration& migration : known)
    schema.readable_from_by_number.emplace(migration.number, migration.readable_from);
  state.readable_after_update = schema.readable_from();
  return state;
}

}  // namespace strata::store
