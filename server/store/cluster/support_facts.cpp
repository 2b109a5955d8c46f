#include "store/cluster/support_facts.h"

#include <cstring>
#include <memory>

#include "store/cluster/inspect.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace {

// Settings that explain most differences between two machines.
constexpr const char* kServer = R"(
  SELECT json_build_object(
    'version', version(),
    'encoding', current_setting('server_encoding'),
    'database_bytes', pg_database_size(current_database()),
    'started', pg_postmaster_start_time(),
    'cache_hits', (SELECT blks_hit::float8 / nullif(blks_hit + blks_read, 0)
                     FROM pg_stat_database WHERE datname = current_database()),
    'deadlocks', (SELECT deadlocks FROM pg_stat_database WHERE datname = current_database()),
    'connections', (SELECT coalesce(json_object_agg(state, n), '{}') FROM
                     (SELECT coalesce(state, 'other') AS state, count(*) AS n
                        FROM pg_stat_activity GROUP BY 1) AS by_state),
    'oldest_transaction_s', (SELECT extract(epoch FROM max(clock_timestamp() - xact_start))
                               FROM pg_stat_activity WHERE pid <> pg_backend_pid()),
    'settings', (SELECT json_object_agg(name, setting || coalesce(' ' || unit, ''))
                   FROM pg_settings WHERE name IN
                     ('autovacuum', 'effective_cache_size', 'fsync', 'full_page_writes',
                      'maintenance_work_mem', 'max_connections', 'max_wal_size', 'shared_buffers',
                      'synchronous_commit', 'wal_level', 'work_mem')))::text)";

constexpr const char* kTables = R"(
  SELECT coalesce(json_agg(one), '[]')::text FROM
    (SELECT schemaname AS schema, relname AS name, pg_total_relation_size(relid) AS total_bytes,
            pg_relation_size(relid) AS table_bytes, pg_indexes_size(relid) AS index_bytes,
            n_live_tup AS rows, n_dead_tup AS dead_rows, seq_scan AS full_scans,
            idx_scan AS index_scans, greatest(last_vacuum, last_autovacuum) AS vacuumed,
            greatest(last_analyze, last_autoanalyze) AS analyzed
       FROM pg_stat_user_tables ORDER BY 3 DESC LIMIT 200) AS one)";

constexpr const char* kIndexes = R"(
  SELECT coalesce(json_agg(one), '[]')::text FROM
    (SELECT schemaname AS schema, relname AS "table", indexrelname AS name,
            pg_relation_size(indexrelid) AS bytes, idx_scan AS scans,
            round(idx_tup_read / nullif(idx_scan, 0)::numeric, 1) AS entries_per_scan
       FROM pg_stat_user_indexes ORDER BY 4 DESC LIMIT 200) AS one)";

Result<nlohmann::json> json_of(PgConnection& connection, const char* statement) {
  auto result = STRATA_TRY(connection.query(statement));
  return nlohmann::json::parse(result.text(0, 0));
}

Result<std::vector<std::string>> texts_of(PgConnection& connection, const char* statement) {
  auto result = STRATA_TRY(connection.query(statement));
  std::vector<std::string> texts;
  for (int row = 0; row < result.rows(); ++row) texts.push_back(result.text(row, 0));
  return texts;
}

// Returns whether libpq marks the option as one that must not be shown.
bool is_secret(const PQconninfoOption& option) {
  return std::strcmp(option.keyword, "password") == 0 ||
         std::strcmp(option.keyword, "sslpassword") == 0 ||
         (option.dispchar && std::strchr(option.dispchar, '*'));
}

std::string quoted(std::string_view value) {
  std::string text = "'";
  for (const char c : value) {
    if (c == '\'' || c == '\\') text += '\\';
    text += c;
  }
  return text + "'";
}

}  // namespace

Result<SupportFacts> support_facts(const std::string& dsn,
                                   const std::filesystem::path& migrations_dir) {
  const auto state = STRATA_TRY(inspect_database(dsn, migrations_dir));
  auto connection = STRATA_TRY(PgConnection::connect(dsn));
  STRATA_TRY(connection.script("SET default_transaction_read_only = on"));
  SupportFacts facts;
  facts.server = STRATA_TRY(json_of(connection, kServer));
  facts.server["schema_version"] = state.schema_version;
  facts.server["schema_of_program"] = state.known_version;
  facts.tables = STRATA_TRY(json_of(connection, kTables));
  facts.indexes = STRATA_TRY(json_of(connection, kIndexes));
  facts.migrations = nlohmann::json::array();
  if (state.schema_version == 0) return facts;
  facts.migrations = STRATA_TRY(json_of(
      connection,
      "SELECT coalesce(json_agg(version ORDER BY version), '[]')::text FROM schema_migrations"));
  facts.people = STRATA_TRY(
      texts_of(connection,
               "SELECT name FROM users UNION SELECT full_name FROM users WHERE full_name <> ''"));
  facts.secrets = STRATA_TRY(texts_of(connection,
                                      "SELECT phone FROM kiosks WHERE phone IS NOT NULL UNION "
                                      "SELECT password FROM users WHERE password IS NOT NULL"));
  auto hashes =
      STRATA_TRY(connection.query("SELECT hash FROM tokens UNION SELECT hash FROM kiosks"));
  for (int row = 0; row < hashes.rows(); ++row) {
    const auto hash = hashes.bytes(row, 0);
    facts.secret_hashes.emplace(reinterpret_cast<const char*>(hash.data()), hash.size());
  }
  return facts;
}

PublicDsn without_passwords(const std::string& dsn) {
  char* error = nullptr;
  const std::unique_ptr<PQconninfoOption, void (*)(PQconninfoOption*)> options(
      PQconninfoParse(dsn.c_str(), &error), &PQconninfoFree);
  const std::unique_ptr<char, void (*)(void*)> owned_error(error, &PQfreemem);
  PublicDsn shown;
  if (!options) return shown;
  for (const PQconninfoOption* option = options.get(); option->keyword; ++option) {
    if (!option->val || !*option->val) continue;
    if (is_secret(*option)) {
      shown.passwords.emplace_back(option->val);
      continue;
    }
    if (!shown.text.empty()) shown.text += ' ';
    shown.text.append(option->keyword).append("=").append(quoted(option->val));
  }
  return shown;
}

}  // namespace strata::store
