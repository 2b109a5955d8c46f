#include "store/cluster/archive_restore.h"

#include <fstream>

#include "core/text/timestamp.h"
#include "store/cluster/cluster.h"
#include "store/cluster/cluster_process.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kLastChange = "last completed transaction was at log time ";
constexpr std::string_view kTooEarlyEnd =
    "recovery ended before configured recovery target was reached";
constexpr std::string_view kNotRestored = "could not restore file \"";

// Returns the rest of the last line that contains `words`, or an empty text.
std::string after_words(const fs::path& log, std::string_view words) {
  std::ifstream in(log);
  std::string found;
  for (std::string line; std::getline(in, line);)
    if (const auto at = line.find(words); at != std::string::npos)
      found = line.substr(at + words.size());
  return found;
}

bool has_words(const fs::path& log, std::string_view words) {
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);)
    if (line.find(words) != std::string::npos) return true;
  return false;
}

// Returns the first segment that is missing between the start of the copy and the newest segment.
std::optional<WalSegment> missing_segment(const ArchiveFolder& archive,
                                          const ArchiveFolder::Copy& copy) {
  const auto segments = archive.segments();
  if (segments.empty()) return std::nullopt;  // the copy itself contains the WAL that it needs
  const WalSegment newest = *segments.rbegin();
  if (newest.timeline != copy.first.timeline) return std::nullopt;
  return first_missing(segments, copy.first, newest);
}

// Explains why PostgreSQL has ended the recovery, from its log.
Error explained(const ArchiveFolder& archive, const RestorePlan& plan, const fs::path& log,
                const Error& problem) {
  if (const auto name = after_words(log, kNotRestored); !name.empty())
    return {ErrorCode::invalid, "Archive damaged",
            "The segment " + name.substr(0, name.find('"')) + " in " + archive.wal().string() +
                " cannot be read. Restore an earlier state with --at.",
            "--archive"};
  if (!has_words(log, kTooEarlyEnd)) return problem;
  std::string last = after_words(log, kLastChange);
  if (last.empty()) last = utc_text(plan.copy.made);
  if (const auto missing = missing_segment(archive, plan.copy))
    return {ErrorCode::invalid, "Archive incomplete",
            "The segment " + wal_name(*missing) + " is missing in " + archive.wal().string() +
                ". The last change before it is from " + last + ". Restore an earlier state.",
            "--at"};
  return {ErrorCode::invalid, "After the last archived change",
          "The last archived change is from " + last +
              ". To restore this state, leave out --at. The server archives later changes within a "
              "minute, and when it stops.",
          "--at"};
}

// PostgreSQL ends the recovery without an error at the first segment that it cannot use, for
// example if the disk of the archive has disappeared.
Result<void> check_replayed(const Cluster& cluster, const RestorePlan& plan) {
  if (plan.moment || !plan.newest || plan.newest->timeline != plan.copy.first.timeline) return {};
  auto connection = STRATA_TRY(PgConnection::connect(cluster.dsn()));
  auto row =
      STRATA_TRY(connection.query("SELECT coalesce(pg_last_wal_replay_lsn() - '0/0', 0)::bigint"));
  if (static_cast<std::uint64_t>(row.integer(0, 0)) > plan.newest->number * kWalSegmentBytes)
    return {};
  return fail(ErrorCode::invalid, "Archive damaged",
              "The recovery ended before the last archived segment, " + wal_name(*plan.newest) +
                  ". A segment is damaged, or the archive was not readable for a moment. Try "
                  "again, or restore an earlier moment with --at.",
              "--archive");
}

// The original site may still use the files outside the database, so the copy must not delete them
// (store/files/files.h). A copy of the cluster has the same identifiers as the original.
Result<void> disown_files(const Cluster& cluster) {
  auto connection = STRATA_TRY(PgConnection::connect(cluster.dsn()));
  return connection.script(
      "DO $$ BEGIN IF to_regclass('public.file_store') IS NOT NULL THEN "
      "UPDATE public.file_store SET owner = ''; END IF; END $$");
}

Result<RestoredSite> read_site(const Cluster& cluster, const RestorePlan& plan) {
  auto connection = STRATA_TRY(PgConnection::connect(cluster.dsn()));
  auto row = STRATA_TRY(
      connection.query("SELECT pg_last_xact_replay_timestamp(), (SELECT count(*) FROM projects), "
                       "(SELECT count(*) FROM models), (SELECT count(*) FROM edits), "
                       "(SELECT max(\"time\") FROM edits)"));
  RestoredSite site;
  site.reached = row.null(0, 0) ? plan.copy.made : row.time(0, 0);
  site.projects = row.integer(0, 1);
  site.models = row.integer(0, 2);
  site.edits = row.integer(0, 3);
  if (!row.null(0, 4)) site.last_edit = row.time(0, 4);
  return site;
}

}  // namespace

Result<RestorePlan> plan_restore(
    const ArchiveFolder& archive,
    const std::optional<std::chrono::system_clock::time_point>& moment) {
  const auto copies = archive.copies();
  if (copies.empty())
    return fail(ErrorCode::not_found, "No complete copy",
                archive.folder().string() +
                    " contains no complete copy of a database yet. The server makes the first copy "
                    "after its start.",
                "--archive");
  if (moment && *moment > std::chrono::system_clock::now())
    return fail(ErrorCode::invalid, "Moment in the future",
                utc_text(*moment) + " is in the future. Enter an earlier moment.", "--at");
  if (moment && *moment < copies.front().made)
    return fail(ErrorCode::not_found, "Before the first copy",
                "The archive begins at " + utc_text(copies.front().made) +
                    ". Enter this moment or a later one.",
                "--at");
  RestorePlan plan{copies.front(), moment, {}};
  if (const auto segments = archive.segments(); !segments.empty()) plan.newest = *segments.rbegin();
  for (const auto& copy : copies)
    if (!moment || copy.made <= *moment) plan.copy = copy;
  // Without a moment, PostgreSQL would take a missing segment as the end of the archive.
  if (!moment)
    if (const auto missing = missing_segment(archive, plan.copy))
      return fail(ErrorCode::invalid, "Archive incomplete",
                  "The segment " + wal_name(*missing) + " is missing in " + archive.wal().string() +
                      ". Restore an earlier state with --at.",
                  "--archive");
  return plan;
}

Result<RestoredSite> restore_archive(const ArchiveFolder& archive, const RestorePlan& plan,
                                     const fs::path& data_dir, Progress& progress) {
  const auto user = STRATA_TRY(database_user());
  const fs::path folder = fs::absolute(data_dir) / "postgres", pgdata = folder / "pgdata",
                 log = folder / "postgres.log";
  STRATA_TRY(give_folder(folder, user));
  const auto goes_on = [&progress] { return !progress.cancelled(); };

  progress.report(0.1, "Unpacking the copy of " + utc_text(plan.copy.made));
  if (auto copied = run_to_end(
          {"/bin/cp", "-R", "-p", "--reflink=auto", plan.copy.folder.string(), pgdata.string()},
          user, log, goes_on);
      !copied) {
    copied.error().detail += " Run the command as the user of the server.";
    return tl::unexpected(copied.error());
  }
  const auto programs = STRATA_TRY(find_programs(data_version(pgdata)));
  progress.report(0.4, "Checking the copy");
  STRATA_TRY(
      run_to_end({programs / "pg_verifybackup", "--quiet", pgdata.string()}, user, log, goes_on));
  STRATA_TRY(
      run_to_end({"/usr/bin/touch", (pgdata / "recovery.signal").string()}, user, log, goes_on));

  progress.report(0.6, "Replaying the changes since the copy");
  ClusterOptions options;
  options.settings = archive.recovery_settings(plan.moment);
  options.patience = std::chrono::seconds(0);
  auto cluster = Cluster::start(data_dir, options);
  if (!cluster) return tl::unexpected(explained(archive, plan, log, cluster.error()));
  STRATA_TRY(check_replayed(**cluster, plan));
  STRATA_TRY(disown_files(**cluster));
  return read_site(**cluster, plan);
}

}  // namespace strata::store
