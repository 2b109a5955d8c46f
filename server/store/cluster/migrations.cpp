#include "store/cluster/migrations.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include "core/digest.h"
#include "core/log.h"
#include "core/text/ascii.h"
#include "core/text/hex.h"
#include "core/text/slug.h"
#include "core/version.h"
#include "store/cluster/inspect.h"

namespace strata::store {
namespace {

// The advisory lock that every server takes when it starts. The number is arbitrary but fixed.
constexpr const char* kTryLock = "SELECT pg_try_advisory_lock(7130915062201)";
constexpr const char* kUnlock = "SELECT pg_advisory_unlock(7130915062201)";
constexpr std::chrono::milliseconds kLockPause{100};

// The migration that added `schema_migrations.readable_from`. Older programs do not read the column
// and refuse every newer database, so no migration is readable for them.
constexpr std::int64_t kFirstReader = 44;

// Returns whether a line is, or was probably meant to be, `-- readable-from: N`.
bool is_about_readers(std::string_view line) {
  const std::string words = to_lower(trimmed(line, " \t\r-"));
  return words.starts_with("readable-from") || words.starts_with("readable_from:") ||
         words.starts_with("readable from:");
}

// Returns N of the line `-- readable-from: N`, or nothing if the line is malformed.
std::optional<std::int64_t> readers_of(std::string_view line, std::int64_t own_number) {
  constexpr std::string_view kStart = "-- readable-from: ";
  if (!line.starts_with(kStart)) return std::nullopt;
  const std::string number(line.substr(kStart.size()));
  if (!is_all_digits(number) || number.size() > 18) return std::nullopt;
  const std::int64_t first = std::stoll(number);
  return first >= kFirstReader && first < own_number ? std::optional(first) : std::nullopt;
}

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
  migration.number = migration.readable_from = std::stoll(migration.version);
  bool up = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("-- migrate:down")) break;
    if (line.starts_with("-- migrate:up")) {
      if (line.find("transaction:false") != std::string::npos)
        return bad("must run in a transaction.");
      up = true;
    } else if (is_about_readers(line)) {
      const auto first = readers_of(line, migration.number);
      if (!first || migration.readable_from != migration.number)
        return bad("`" + line + "` must be `-- readable-from: N`, where N is at least " +
                   std::to_string(kFirstReader) +
                   " and less than the number of the migration. The line may occur only once.");
      migration.readable_from = *first;
    } else if (up) {
      migration.sql += line + "\n";
    }
  }
  if (!up) return bad("has no line `-- migrate:up`.");
  return migration;
}

// The columns exist from migration kFirstReader on.
Result<void> store_readers(PgConnection& connection, const Migration& migration) {
  std::optional<std::int64_t> first;
  if (migration.readable_from < migration.number) first = migration.readable_from;
  STRATA_TRY(connection.query(
      "UPDATE schema_migrations SET readable_from = $2, applied_by = $3 WHERE version = $1",
      Params().text(migration.version).optional_integer(first).text(version())));
  return {};
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
  if (migration.number >= kFirstReader) STRATA_TRY(store_readers(connection, migration));
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

tl::unexpected<Error> newer_database(const Schema& schema, const std::string& migration,
                                     std::int64_t newest_known) {
  return fail(
      ErrorCode::conflict, "Database is newer",
      "The database has migration " + migration + ". Only programs with migration " +
          std::to_string(schema.readable_from()) +
          " or a later one can use the database, and the last migration of this program is " +
          std::to_string(newest_known) + ". " + newer_version_advice(schema.applied_by));
}

tl::unexpected<Error> different_migrations(const Schema& schema, const std::string& why) {
  return fail(ErrorCode::conflict, "Migrations differ",
              why + " " + newer_version_advice(schema.applied_by));
}

Result<void> check_unchanged(PgConnection& connection, const Migration& ours,
                             const std::string& applied_sum) {
  if (applied_sum == ours.sha256) return {};
  if (!applied_sum.empty())
    return fail(ErrorCode::conflict, "Migration changed",
                "Migration " + ours.name +
                    " has changed since it was applied. Do not edit applied migrations: restore "
                    "the file and put the change into a new migration.");
  // dbmate applied the migration
  STRATA_TRY(connection.query("INSERT INTO schema_checksums (version, sha256) VALUES ($1, $2)",
                              Params().text(ours.version).text(ours.sha256)));
  if (ours.number >= kFirstReader) STRATA_TRY(store_readers(connection, ours));
  return {};
}

Result<Schema> migrate_locked(PgConnection& connection, const std::vector<Migration>& known) {
  STRATA_TRY(make_tables(connection));
  auto schema = STRATA_TRY(read_schema(connection));
  auto rows = STRATA_TRY(connection.query(
      "SELECT m.version, c.sha256 FROM schema_migrations m "
      "LEFT JOIN schema_checksums c USING (version) ORDER BY length(m.version), m.version"));
  const std::int64_t newest_known = known.empty() ? 0 : known.back().number;
  std::set<std::string> applied;
  std::string newer;  // the last applied migration that this program does not have
  for (int i = 0; i < rows.rows(); ++i) {
    const std::string version = rows.text(i, 0);
    applied.insert(version);
    const auto ours = std::ranges::find(known, version, &Migration::version);
    if (ours != known.end()) {
      STRATA_TRY(check_unchanged(connection, *ours, rows.null(i, 1) ? "" : rows.text(i, 1)));
      continue;
    }
    if (std::stoll(version) < newest_known)
      return different_migrations(schema, "The database has migration " + version +
                                              ", which this program lacks, although it has later "
                                              "migrations.");
    if (schema.readable_from() > newest_known) return newer_database(schema, version, newest_known);
    newer = version;
  }
  for (const Migration& migration : known) {
    if (applied.contains(migration.version)) continue;
    if (!newer.empty())
      return different_migrations(schema, "The database has migration " + newer +
                                              ", but it lacks the earlier migration " +
                                              migration.name + " of this program.");
    STRATA_TRY(apply_one(connection, migration));
    log::info("database: applied migration " + migration.name);
  }
  if (!newer.empty()) {
    log::info("database: has migration " + newer + ", which is newer than this program (" +
              std::to_string(newest_known) + ") and which it can use");
    return schema;
  }
  return read_schema(connection);
}

// Tries again and again instead of waiting in the database, so that the wait has a limit and the
// log shows its reason.
Result<void> take_lock(PgConnection& connection, std::chrono::milliseconds wait) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + wait;
  const std::string limit =
      std::to_string(std::chrono::duration_cast<std::chrono::seconds>(wait).count()) + " s";
  for (bool logged = false;;) {
    const auto taken = STRATA_TRY(connection.query(kTryLock));
    if (taken.boolean(0, 0)) return {};
    if (Clock::now() >= end)
      return fail(ErrorCode::unavailable, "Database is being updated",
                  "Another server has been updating the database for more than " + limit +
                      ". Start this server again when the other one has finished.");
    if (!std::exchange(logged, true))
      log::info("database: waiting up to " + limit + " while another server updates it");
    std::this_thread::sleep_for(kLockPause);
  }
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

std::int64_t Schema::version() const {
  return readable_from_by_number.empty() ? 0 : readable_from_by_number.rbegin()->first;
}

std::int64_t Schema::readable_from() const {
  std::int64_t first = 0;
  for (auto newest = readable_from_by_number.rbegin(); newest != readable_from_by_number.rend();
       ++newest) {
    if (newest->first <= first) break;
    first = std::max(first, newest->second);
  }
  return first;
}

// Uses to_jsonb, because databases of older programs do not have the columns.
Result<Schema> read_schema(PgConnection& connection) {
  auto rows = STRATA_TRY(connection.query(
      "SELECT version::bigint, coalesce((to_jsonb(m) ->> 'readable_from')::bigint, version::bigint), "
      "coalesce(to_jsonb(m) ->> 'applied_by', '') FROM schema_migrations m ORDER BY 1"));
  Schema schema;
  for (int i = 0; i < rows.rows(); ++i) {
    schema.readable_from_by_number[rows.integer(i, 0)] = rows.integer(i, 1);
    schema.applied_by = rows.text(i, 2);
  }
  return schema;
}

Result<Schema> migrate(PgConnection& connection, const std::vector<Migration>& known,
                       std::chrono::milliseconds wait) {
  STRATA_TRY(take_lock(connection, wait));
  auto outcome = migrate_locked(connection, known);
  (void)connection.script(kUnlock);  // a broken connection has already released its lock
  return outcome;
}

}  // namespace strata::store
