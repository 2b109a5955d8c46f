#include "store/cluster/migrations.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "core/digest.h"
#include "core/log.h"
#include "core/text/hex.h"
#include "core/text/slug.h"

namespace strata::store {
namespace {

// The advisory lock that every server takes when it starts. The number is arbitrary but fixed.
constexpr const char* kLock = "SELECT pg_advisory_lock(7130915062201)";
constexpr const char* kUnlock = "SELECT pg_advisory_unlock(7130915062201)";

Result<Migration> parse(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  const auto bad = [&](const std::string& why) {
    return fail(ErrorCode::internal, "Invalid migration", name + ": " + why, "migrations");
  };
  std::ifstream in(file, std::ios::binary);
  std::stringstream content;
  content << in.rdbuf();
  if (!in) return bad("cannot be read.");
  const std::string text = content.str();
  Migration migration{name.substr(0, name.find('_')), name, {}, to_hex(sha256(text))};
  if (!is_all_digits(migration.version) || migration.version.size() > 18)
    return bad("the name must start with digits and an underscore.");
  bool up = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("-- migrate:down")) break;
    if (line.starts_with("-- migrate:up")) {
      if (line.find("transaction:false") != std::string::npos)
        return bad("must run in a transaction.");
      up = true;
    } else if (up) {
      migration.sql += line + "\n";
    }
  }
  if (!up) return bad("has no line `-- migrate:up`.");
  return migration;
}

Result<void> apply_one(PgConnection& connection, const Migration& migration) {
  auto transaction = STRATA_TRY(Transaction::begin(connection));
  STRATA_TRY(connection.query("INSERT INTO schema_migrations (version) VALUES ($1)",
                              Params().text(migration.version)));
  STRATA_TRY(connection.query("INSERT INTO schema_checksums (version, sha256) VALUES ($1, $2)",
                              Params().text(migration.version).text(migration.sha256)));
  if (auto done = connection.script(migration.sql); !done) {
    Error problem = done.error();
    problem.detail = "Migration " + migration.name + " failed: " + problem.detail;
    return tl::unexpected(problem);
  }
  return transaction.commit();
}

Result<void> make_tables(PgConnection& connection) {
  auto known =
      STRATA_TRY(connection.query("SELECT to_regclass('schema_migrations') IS NOT NULL, "
                                  "to_regclass('schema_checksums') IS NOT NULL"));
  if (!known.boolean(0, 0)) {
    STRATA_TRY(connection.script(
        "CREATE TABLE schema_migrations (version character varying(128) PRIMARY KEY)"));
  }
  if (known.boolean(0, 1)) return {};
  return connection.script(
      "CREATE TABLE schema_checksums (version character varying(128) PRIMARY KEY, "
      "sha256 text NOT NULL)");
}

Result<std::int64_t> migrate_locked(PgConnection& connection, const std::vector<Migration>& known) {
  STRATA_TRY(make_tables(connection));
  auto rows = STRATA_TRY(connection.query(
      "SELECT m.version, c.sha256 FROM schema_migrations m "
      "LEFT JOIN schema_checksums c USING (version) ORDER BY length(m.version), m.version"));
  std::map<std::string, std::string> applied;
  for (int i = 0; i < rows.rows(); ++i)
    applied[rows.text(i, 0)] = rows.null(i, 1) ? "" : rows.text(i, 1);

  for (const auto& [version, sum] : applied) {
    const auto ours = std::ranges::find(known, version, &Migration::version);
    if (ours == known.end())
      return fail(ErrorCode::conflict, "Database is newer",
                  "The database has migration " + version +
                      ", which is newer than this version of Strata. Start the version that "
                      "applied it, or a later version.");
    if (!sum.empty() && sum != ours->sha256)
      return fail(ErrorCode::conflict, "Migration changed",
                  "Migration " + ours->name +
                      " has changed since it was applied. Do not edit applied migrations: restore "
                      "the file and put the change into a new migration.");
    if (sum.empty()) {  // dbmate applied the migration
      STRATA_TRY(connection.query("INSERT INTO schema_checksums (version, sha256) VALUES ($1, $2)",
                                  Params().text(version).text(ours->sha256)));
    }
  }
  for (const Migration& migration : known) {
    if (applied.contains(migration.version)) continue;
    STRATA_TRY(apply_one(connection, migration));
    log::info("database: applied migration " + migration.name);
  }
  return known.empty() ? 0 : std::stoll(known.back().version);
}

}  // namespace

Result<std::vector<Migration>> read_migrations(const std::filesystem::path& folder) {
  std::vector<Migration> migrations;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".sql") continue;
    auto migration = STRATA_TRY(parse(entry.path()));
    migrations.push_back(std::move(migration));
  }
  if (error || migrations.empty())
    return fail(ErrorCode::internal, "No migrations",
                "There are no migration files in " + folder.string() +
                    ". Check that the installation is complete.");
  std::sort(migrations.begin(), migrations.end(), [](const Migration& a, const Migration& b) {
    return std::stoll(a.version) < std::stoll(b.version);
  });
  for (std::size_t i = 1; i < migrations.size(); ++i)
    if (std::stoll(migrations[i - 1].version) == std::stoll(migrations[i].version))
      return fail(
          ErrorCode::internal, "Invalid migration",
          migrations[i - 1].name + " and " + migrations[i].name + " have the same version.");
  return migrations;
}

Result<std::int64_t> migrate(PgConnection& connection, const std::vector<Migration>& known) {
  STRATA_TRY(connection.script(kLock));
  auto outcome = migrate_locked(connection, known);
  (void)connection.script(kUnlock);  // a broken connection has already released its lock
  return outcome;
}

}  // namespace strata::store
