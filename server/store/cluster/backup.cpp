#include "store/cluster/backup.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/digest.h"
#include "core/text/hex.h"
#include "store/cluster/cluster_process.h"
#include "store/cluster/scratch_folder.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

constexpr int kFormat = 1;
constexpr const char* kDump = "database.dump";
constexpr const char* kManifest = "manifest.json";
constexpr std::uintmax_t kMaxManifest = 64u << 20;

Error damaged(const fs::path& folder, const std::string& why) {
  return {ErrorCode::invalid, "Backup damaged", folder.string() + ": " + why, {}};
}

// --- PostgreSQL programs

// Escapes a value for a field of libpq's password file.
std::string passfile_field(std::string_view value) {
  std::string out;
  for (const char c : value) {
    if (c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

// Moves the password of a connection string into a password file, because every user of the machine
// can see the arguments of pg_dump and pg_restore.
Result<std::string> hide_password(const std::string& dsn, const fs::path& file) {
  char* error = nullptr;
  const std::unique_ptr<PQconninfoOption, void (*)(PQconninfoOption*)> options(
      PQconninfoParse(dsn.c_str(), &error), &PQconninfoFree);
  if (!options) {
    const std::string why = error ? error : "The connection string cannot be parsed.";
    PQfreemem(error);
    return fail(ErrorCode::malformed, "Invalid connection string", why, "--database");
  }
  std::string shown, password;
  for (const PQconninfoOption* option = options.get(); option->keyword; ++option) {
    if (!option->val) continue;
    if (std::string_view(option->keyword) == "password")
      password = option->val;
    else
      shown += std::string(option->keyword) + "=" + dsn_value(option->val) + " ";
  }
  if (password.empty()) return shown;
  std::ofstream out(file);
  std::error_code ignored;
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write, ignored);
  out << "*:*:*:*:" << passfile_field(password) << "\n";
  out.close();
  if (!out)
    return fail(ErrorCode::storage_full, "Disk full", "Cannot write " + file.string() + ".");
  return shown + "passfile=" + dsn_value(file.string());
}

// Calls `watch` while the program runs. The output of the program goes to `log`.
Result<void> run_program(const std::vector<std::string>& command, const fs::path& log,
                         const Progress& progress, const std::function<void()>& watch) {
  return run_to_end(command, DatabaseUser{}, log, [&] {
    watch();
    return !progress.cancelled();
  });
}

// pg_restore of this version and later begins with a setting that older servers do not have
// (transaction_timeout).
constexpr int kSetsTransactionTimeout = 17;

// Returns the path of pg_dump or pg_restore. Prefers the version of the server. A newer pg_dump
// reads each older server, but a newer pg_restore cannot write to each of them.
Result<fs::path> program_for(PgConnection& connection, const char* name, bool writes) {
  auto version =
      STRATA_TRY(connection.query("SELECT current_setting('server_version_num')::int8 / 10000"));
  std::error_code error;
  const int wanted = static_cast<int>(version.integer(0, 0));
  if (const auto same = find_programs(wanted); same && fs::exists(*same / name, error))
    return *same / name;
  if (writes && wanted < kSetsTransactionTimeout &&
      installed_programs().rbegin()->first >= kSetsTransactionTimeout)
    return fail(ErrorCode::unsupported, "Program missing",
                "A newer pg_restore cannot restore into PostgreSQL " + std::to_string(wanted) +
                    ". Install postgresql-client-" + std::to_string(wanted) + ".");
  const auto newest = STRATA_TRY(find_programs(0));
  return newest / name;
}

// --- the content of a database

Result<PgConnection> connect(const std::string& dsn) {
  auto connection = STRATA_TRY(PgConnection::connect(dsn, kMigrationLimits));
  // Rows are compared as text, so fix all settings that affect how a value is written.
  if (auto set = connection.script(
          "SET datestyle = 'ISO'; SET intervalstyle = 'postgres'; SET timezone = 'UTC'; "
          "SET extra_float_digits = 1; SET bytea_output = 'hex'; SET search_path = ''");
      !set)
    return tl::unexpected(set.error());
  return connection;
}

struct Relation {
  std::string name;  // quoted and with its schema
  std::int64_t bytes;
};

Result<std::vector<Relation>> relations(PgConnection& connection, const char* kind) {
  auto found = STRATA_TRY(connection.query_once(
      "SELECT format('%I.%I', n.nspname, c.relname), pg_catalog.pg_table_size(c.oid) FROM pg_catalog.pg_class c "
      "JOIN pg_catalog.pg_namespace n ON n.oid = c.relnamespace WHERE c.relkind = '" +
      std::string(kind) +
      "' AND n.nspname !~ '^pg_' AND n.nspname <> 'information_schema' ORDER BY 1"));
  std::vector<Relation> list;
  for (int row = 0; row < found.rows(); ++row)
    list.push_back({found.text(row, 0), found.integer(row, 1)});
  return list;
}

// Reads the time, the schema version and the PostgreSQL version.
Result<BackupFacts> read_state(PgConnection& connection) {
  auto state = STRATA_TRY(connection.query(
      "SELECT to_char(now() AT TIME ZONE 'UTC', 'YYYY-MM-DD\"T\"HH24:MI:SS\"Z\"'), "
      "(SELECT max(version::int8) FROM public.schema_migrations), current_setting('server_version')"));
  BackupFacts facts;
  facts.made = state.text(0, 0);
  facts.schema_version = state.integer(0, 1);
  facts.server_version = state.text(0, 2);
  return facts;
}

// A database of an older version has no table of files.
Result<BackupFacts::Files> read_files(PgConnection& connection, const BackupFacts& facts) {
  if (facts.rows_of("public.file_store") == 0) return BackupFacts::Files{};
  auto row =
      STRATA_TRY(connection.query_once("SELECT count(*), coalesce(sum(bytes), 0)::bigint, "
                                       "(SELECT place FROM public.file_store) FROM public.blobs "
                                       "WHERE is_outside AND removing IS NULL"));
  return BackupFacts::Files{row.integer(0, 0), row.integer(0, 1), row.text(0, 2)};
}

Result<void> read_contents(PgConnection& connection, BackupFacts& facts, Progress& progress) {
  const auto tables = STRATA_TRY(relations(connection, "r"));
  std::int64_t all = 1, done = 0;
  for (const Relation& table : tables) all += table.bytes;
  for (const Relation& table : tables) {
    if (progress.cancelled()) return cancelled_problem();
    progress.report(double(done) / double(all), "Reading the tables");
    // Add up 60 bits of a hash of each row. The order of the rows has no effect on the sum, and two
    // equal rows do not cancel each other.
    auto sum = STRATA_TRY(connection.query_once(
        "SELECT count(*), coalesce(sum(('x' || left(md5(t::text), 15))::bit(60)::int8), 0)::text FROM ONLY " +
        table.name + " t"));
    facts.tables[table.name] = {sum.integer(0, 0), sum.text(0, 1)};
    done += table.bytes;
  }
  const auto sequences = STRATA_TRY(relations(connection, "S"));
  for (const Relation& sequence : sequences) {
    auto last = STRATA_TRY(connection.query_once(
        "SELECT CASE WHEN is_called THEN last_value ELSE last_value - 1 END FROM " +
        sequence.name));
    facts.sequences[sequence.name] = last.integer(0, 0);
  }
  return {};
}

// --- the files

Result<void> read_dump(const fs::path& file, BackupFacts& facts, Progress& progress) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    return fail(ErrorCode::not_found, "Backup not found", "Cannot read " + file.string() + ".");
  std::error_code error;
  const double size = std::max<double>(1, double(fs::file_size(file, error)));
  Sha256Stream digest;
  std::vector<char> piece(1u << 20);
  while (in) {
    if (progress.cancelled()) return cancelled_problem();
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto count = static_cast<std::size_t>(in.gcount());
    digest.add({reinterpret_cast<const std::uint8_t*>(piece.data()), count});
    facts.bytes += count;
    progress.report(double(facts.bytes) / size, "Reading the dump");
  }
  if (in.bad())
    return fail(ErrorCode::internal, "Backup not readable",
                "Reading " + file.string() + " failed.");
  facts.sha256 = to_hex(digest.finish());
  return {};
}

json to_json(const BackupFacts& facts) {
  json tables = json::object();
  for (const auto& [name, table] : facts.tables)
    tables[name] = {{"rows", table.rows}, {"digest", table.digest}};
  json manifest{{"format", kFormat},
                {"made", facts.made},
                {"schema_version", facts.schema_version},
                {"postgresql", facts.server_version},
                {"dump", {{"bytes", facts.bytes}, {"sha256", facts.sha256}}},
                {"tables", std::move(tables)},
                {"sequences", facts.sequences}};
  if (facts.files.count > 0)
    manifest["files"] = {
        {"count", facts.files.count}, {"bytes", facts.files.bytes}, {"place", facts.files.place}};
  return manifest;
}

Result<BackupFacts> read_manifest(const fs::path& folder) {
  const fs::path file = folder / kManifest;
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error)
    return fail(
        ErrorCode::not_found, "Backup not found",
        "There is no file " + file.string() + ". Enter a folder that `strata backup` has written.");
  if (size > kMaxManifest) return tl::unexpected(damaged(folder, "the manifest is too large."));
  std::ifstream in(file);
  const json manifest = json::parse(in, nullptr, false);
  try {
    if (manifest.at("format").get<int>() != kFormat)
      return fail(ErrorCode::invalid, "Newer backup format",
                  folder.string() +
                      " was written by a newer version of Strata. Restore it with that version.");
    BackupFacts facts;
    facts.made = manifest.at("made").get<std::string>();
    facts.schema_version = manifest.at("schema_version").get<std::int64_t>();
    facts.server_version = manifest.at("postgresql").get<std::string>();
    facts.bytes = manifest.at("dump").at("bytes").get<std::uint64_t>();
    facts.sha256 = manifest.at("dump").at("sha256").get<std::string>();
    for (const auto& [name, table] : manifest.at("tables").items())
      facts.tables[name] = {table.at("rows").get<std::int64_t>(),
                            table.at("digest").get<std::string>()};
    facts.sequences = manifest.at("sequences").get<std::map<std::string, std::int64_t>>();
    if (const auto files = manifest.find("files"); files != manifest.end())
      facts.files = {files->at("count").get<std::int64_t>(), files->at("bytes").get<std::int64_t>(),
                     files->at("place").get<std::string>()};
    return facts;
  } catch (const json::exception&) {
    return tl::unexpected(
        damaged(folder, std::string(kManifest) + " is not the manifest of a backup."));
  }
}

Result<void> write_file(const fs::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out)
    return fail(ErrorCode::storage_full, "Disk full", "Cannot write " + file.string() + ".");
  return {};
}

Result<void> dump(PgConnection& connection, const std::string& dsn, const std::string& snapshot,
                  const fs::path& folder, std::uint64_t database_bytes, Progress& progress) {
  const auto pg_dump = STRATA_TRY(program_for(connection, "pg_dump", false));
  // not in the folder of the backup, because that disk may be full
  const auto scratch = STRATA_TRY(ScratchFolder::make("backup"));
  const auto client = STRATA_TRY(hide_password(dsn, scratch.folder() / "password"));
  const fs::path file = folder / kDump;
  return run_program({pg_dump, "--format=custom", "--compress=1", "--no-owner", "--no-privileges",
                      "--snapshot=" + snapshot, "--file=" + file.string(), "--dbname=" + client},
                     scratch.folder() / "log", progress, [&] {
                       std::error_code not_yet;
                       const auto size = fs::file_size(file, not_yet);
                       if (!not_yet)
                         progress.report(std::min(0.99, double(size) / double(database_bytes + 1)),
                                         "Writing, " + std::to_string(size >> 20) + " MB so far");
                     });
}

}  // namespace

std::int64_t BackupFacts::rows_of(const std::string& table) const {
  const auto found = tables.find(table);
  return found == tables.end() ? 0 : found->second.rows;
}

Result<BackupFacts> write_backup(const std::string& dsn, const fs::path& folder,
                                 Progress& progress) {
  std::error_code error;
  if (fs::exists(folder, error))
    return fail(
        ErrorCode::conflict, "Folder already exists",
        folder.string() + " already exists. A backup creates a new folder: enter another path.",
        "folder");
  auto connection = STRATA_TRY(connect(dsn));

  // Only the owner can read a backup, because it contains everything, also the hashes of passwords.
  fs::path part = folder;
  part += ".part";
  fs::remove_all(part, error);  // a process that was killed may have left it
  fs::create_directories(fs::absolute(part, error).parent_path(), error);
  if (mkdir(part.c_str(), 0700) != 0)
    return fail(ErrorCode::internal, "Cannot create folder",
                part.string() + ": " + std::strerror(errno) + ".", "folder");
  ScratchFolder unfinished(part);

  const auto moment = STRATA_TRY(Transaction::begin_reading(connection));
  auto facts = STRATA_TRY(read_state(connection));
  auto state = STRATA_TRY(
      connection.query("SELECT pg_export_snapshot(), pg_database_size(current_database())"));

  // Read the contents before the dump, because sequences are not part of a snapshot. The sequences
  // in the dump then have the values that were read here, or later ones.
  progress.begin_stage(0, 0.4);
  STRATA_TRY(read_contents(connection, facts, progress));
  facts.files = STRATA_TRY(read_files(connection, facts));
  progress.begin_stage(0.4, 0.9);
  if (auto dumped = dump(connection, dsn, state.text(0, 0), part,
                         static_cast<std::uint64_t>(state.integer(0, 1)), progress);
      !dumped)
    return tl::unexpected(dumped.error());
  progress.begin_stage(0.9, 1);
  STRATA_TRY(read_dump(part / kDump, facts, progress));
  STRATA_TRY(write_file(part / kManifest, to_json(facts).dump(2) + "\n"));
  if (const auto failed = unfinished.keep_as(folder))
    return fail(ErrorCode::internal, "Backup not written",
                "Cannot rename the folder to " + folder.string() + ": " + failed.message() + ".");
  return facts;
}

Result<BackupFacts> check_backup(const fs::path& folder, Progress& progress) {
  auto facts = STRATA_TRY(read_manifest(folder));
  BackupFacts found;
  STRATA_TRY(read_dump(folder / kDump, found, progress));
  if (found.bytes != facts.bytes)
    return tl::unexpected(
        damaged(folder, std::string(kDump) + " has " + std::to_string(found.bytes) +
                            " bytes, but " + std::to_string(facts.bytes) + " bytes were written."));
  if (found.sha256 != facts.sha256)
    return tl::unexpected(damaged(
        folder, std::string(kDump) + " has changed since it was written: its checksum differs."));
  return facts;
}

Result<void> restore_backup(const fs::path& folder, const BackupFacts& facts,
                            const std::string& dsn, Progress& progress) {
  auto connection = STRATA_TRY(connect(dsn));
  const auto there = STRATA_TRY(relations(connection, "r"));
  if (!there.empty())
    return fail(
        ErrorCode::conflict, "Database not empty",
        "A backup can be restored only into an empty database. This database has the table " +
            there.front().name + ".",
        "--database");
  const auto pg_restore = STRATA_TRY(program_for(connection, "pg_restore", true));

  const auto scratch = STRATA_TRY(ScratchFolder::make("backup"));
  const auto client = STRATA_TRY(hide_password(dsn, scratch.folder() / "password"));
  progress.begin_stage(0, 0.7);
  STRATA_TRY(run_program({pg_restore, "--exit-on-error", "--single-transaction", "--no-owner",
                          "--no-privileges", "--dbname=" + client, (folder / kDump).string()},
                         scratch.folder() / "log", progress,
                         [&] { progress.report(0.5, "Restoring"); }));

  progress.begin_stage(0.7, 1);
  BackupFacts now;
  const auto moment = STRATA_TRY(Transaction::begin_reading(connection));
  STRATA_TRY(read_contents(connection, now, progress));
  if (const std::string wrong = difference(facts, now); !wrong.empty())
    return tl::unexpected(damaged(folder, wrong));
  return {};
}

Result<BackupFacts> read_facts(const std::string& dsn, Progress& progress) {
  auto connection = STRATA_TRY(connect(dsn));
  const auto moment = STRATA_TRY(Transaction::begin_reading(connection));
  auto facts = STRATA_TRY(read_state(connection));
  STRATA_TRY(read_contents(connection, facts, progress));
  return facts;
}

std::string difference(const BackupFacts& expected, const BackupFacts& found) {
  for (const auto& [name, table] : expected.tables)
    if (const auto same = found.tables.find(name);
        same == found.tables.end() || same->second != table)
      return "the table " + name + " differs from the original.";
  for (const auto& [name, last] : expected.sequences)
    if (const auto same = found.sequences.find(name);
        same == found.sequences.end() || same->second < last)
      return "the sequence " + name + " would assign numbers that are in use.";
  return {};
}

}  // namespace strata::store
