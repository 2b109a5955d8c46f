#include "store/cluster/upgrade.h"

#include <fcntl.h>
#include <linux/fs.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "store/cluster/archive_folder.h"
#include "store/cluster/cluster.h"
#include "store/cluster/cluster_process.h"
#include "store/cluster/scratch_folder.h"
#include "store/files/files_mark.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace fs = std::filesystem;
namespace {

using namespace std::chrono_literals;
using Method = UpgradePlan::Method;

constexpr auto kEndPatience = 30s;
constexpr std::uintmax_t kSpareBytes = 256u
                                       << 20;  // the system tables and the WAL of a new cluster
constexpr std::uintmax_t kMostLogBytes = 2u << 30;  // max_wal_size (cluster.cpp)
// A rehearsal leaves this for the running server: without space, its PostgreSQL stops.
constexpr std::uintmax_t kBytesOfServer = 1u << 30;
constexpr std::uintmax_t kFewBytesOfServer = 512u << 20;  // then the rehearsal is cancelled
constexpr std::size_t kMaxReportBytes = 4000;
constexpr int kChecksumsByDefault = 18;  // since this version, initdb turns checksums on

bool has_all(const fs::path& folder, std::initializer_list<const char*> programs) {
  std::error_code error;
  return std::all_of(programs.begin(), programs.end(),
                     [&](const char* program) { return fs::exists(folder / program, error); });
}

// Returns whether files of the folder can share their blocks. Leaves no file in the folder.
bool can_clone(const fs::path& folder, const fs::path& file) {
  const int from = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const int to = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  const bool cloned = from >= 0 && to >= 0 && ioctl(to, FICLONE, from) == 0;
  if (from >= 0) close(from);
  if (to >= 0) close(to);
  return cloned;
}

Result<Method> choose_method(const UpgradePlan& plan, bool dump) {
  if (!dump && has_all(plan.old_programs, {"pg_ctl", "pg_controldata", "pg_resetwal"}) &&
      has_all(plan.new_programs, {"pg_upgrade", "pg_dump", "pg_dumpall", "pg_restore", "psql",
                                  "vacuumdb", "pg_ctl", "pg_controldata", "pg_resetwal"}))
    return can_clone(plan.data, plan.cluster() / "pgdata/PG_VERSION") ? Method::clone
                                                                      : Method::copy;
  if ((has_all(plan.old_programs, {"pg_dump"}) || has_all(plan.new_programs, {"pg_dump"})) &&
      has_all(plan.new_programs, {"initdb", "pg_restore"}))
    return Method::dump;
  return fail(ErrorCode::internal, "Programs missing",
              plan.new_programs.string() +
                  " has neither pg_upgrade nor pg_restore and initdb. Install postgresql-" +
                  std::to_string(plan.to) + " and postgresql-client-" + std::to_string(plan.to) +
                  ".");
}

std::uintmax_t size_of(const fs::path& folder) {
  std::error_code error;
  std::uintmax_t bytes = 0;
  for (auto entry = fs::recursive_directory_iterator(
           folder, fs::directory_options::skip_permission_denied, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code gone;  // a running server deletes files
    if (const auto size = entry->file_size(gone); !gone && entry->is_regular_file(gone))
      bytes += size;
  }
  return bytes;
}

// Another user, also root, would change the owner of the old cluster, or could not read it.
Result<void> check_owner(const fs::path& pgdata, const DatabaseUser& user) {
  struct stat info {};
  if (stat(pgdata.c_str(), &info) != 0 || info.st_uid == user.uid) return {};
  const passwd* owner = getpwuid(info.st_uid);
  return fail(ErrorCode::forbidden, "Data of another user",
              pgdata.string() + " belongs to the user " +
                  (owner ? owner->pw_name : std::to_string(info.st_uid)) +
                  ". Run the command as this user, for example with `sudo -u`.");
}

// The new cluster is made on the disk of the data folder, and then renamed to `postgres`.
Result<void> check_same_disk(const UpgradePlan& plan) {
  struct stat data {
  }, cluster{};
  if (stat(plan.data.c_str(), &data) != 0 || stat(plan.cluster().c_str(), &cluster) != 0 ||
      data.st_dev == cluster.st_dev)
    return {};
  return fail(ErrorCode::unsupported, "Folder of another disk",
              plan.cluster().string() +
                  " is the root of a file system, so it cannot be renamed. Restore a backup into a "
                  "new folder with `strata restore` instead.");
}

Result<void> check_space(const UpgradePlan& plan, bool rehearse) {
  const auto needed = plan.needed_bytes(rehearse);
  if (plan.free_bytes >= needed) return {};
  return fail(ErrorCode::storage_full, "Disk too full",
              "The disk of " + plan.data.string() + " has " +
                  std::to_string(plan.free_bytes >> 20) + " MB of free space, but " +
                  std::to_string(needed >> 20) + " MB are needed.");
}

// Excludes a second upgrade or rehearsal, which would delete the new cluster of the first one. The
// lock of the old cluster is not enough, because a server may have it during a rehearsal.
class UpgradeLock {
 public:
  explicit UpgradeLock(const fs::path& data)
      : fd_(open(data.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {}
  ~UpgradeLock() {
    if (fd_ >= 0) close(fd_);
  }
  UpgradeLock(const UpgradeLock&) = delete;
  UpgradeLock& operator=(const UpgradeLock&) = delete;
  bool taken() const { return fd_ >= 0 && flock(fd_, LOCK_EX | LOCK_NB) == 0; }

 private:
  int fd_;
};

// Returns whether the database owns the files outside (store/files/files.h). A database of an older
// version has no table of files.
Result<bool> owns_files(const std::string& dsn) {
  auto connection = STRATA_TRY(PgConnection::connect(dsn));
  const auto table =
      STRATA_TRY(connection.query("SELECT to_regclass('public.file_store') IS NOT NULL"));
  if (!table.boolean(0, 0)) return false;
  const auto row = STRATA_TRY(connection.query(
      sql("SELECT 1 FROM public.file_store WHERE starts_with(owner, ", kDatabaseId, " || '/')")));
  return row.rows() > 0;
}

// Cancels a rehearsal next to a running server when the disk is nearly full.
class SpaceWatch {
 public:
  SpaceWatch(const UpgradePlan& plan, Progress& progress)
      : watcher_([this, folder = plan.data, &progress](const std::stop_token& stop) {
          std::mutex mutex;
          std::unique_lock lock(mutex);
          std::condition_variable_any stopped;
          while (!stopped.wait_for(lock, stop, 1s, [] { return false; }) &&
                 !stop.stop_requested()) {
            std::error_code error;
            const auto space = fs::space(folder, error);
            if (error || space.available >= kFewBytesOfServer) continue;
            ran_out_ = true;
            return progress.cancel();
          }
        }) {}
  bool ran_out() const { return ran_out_; }

 private:
  std::atomic<bool> ran_out_{false};
  std::jthread watcher_;  // the first to end
};

// --- one upgrade

class Upgrade {
 public:
  Upgrade(const UpgradePlan& plan, DatabaseUser user, Progress& progress)
      : plan_(plan), user_(std::move(user)), progress_(progress), work_(plan.work()) {}

  // Makes the new cluster and compares it with the old one. PostgreSQL is then stopped. Both
  // folders stay locked as long as this object exists.
  Result<BackupFacts> make() {
    STRATA_TRY(clear());
    if (plan_.running && plan_.method == Method::dump)
      return make_by_dump(Cluster::inspect(plan_.data).dsn);
    fs::path source = plan_.data;
    if (plan_.running) {
      source = plan_.work() / "copy";
      STRATA_TRY(copy_running(source / "postgres"));
    }
    ClusterOptions options;
    options.settings = {"autovacuum=off"};  // the old cluster must not change
    auto old = STRATA_TRY(Cluster::start(source, options));
    old_ = std::move(old);
    return plan_.method == Method::dump ? make_by_dump(old_->dsn()) : make_by_upgrade();
  }

  Result<void> put_into_place() {
    if (progress_.cancelled()) return cancelled_problem();
    std::error_code error, ignored;
    fs::rename(plan_.cluster(), plan_.fallback, error);
    if (!error) {
      fs::rename(new_folder(), plan_.cluster(), error);
      if (error) fs::rename(plan_.fallback, plan_.cluster(), ignored);
    }
    if (error)
      return fail(ErrorCode::internal, "Cluster not renamed",
                  "Cannot rename " + plan_.cluster().string() + " to " + plan_.fallback.string() +
                      " and " + new_folder().string() + " to " + plan_.cluster().string() + ": " +
                      error.message() + ".");
    sync_folder(plan_.data);
    return {};
  }

 private:
  fs::path new_folder() const { return plan_.work() / "postgres"; }
  fs::path new_data() const { return new_folder() / "pgdata"; }
  // The log is in the folder of the old cluster, because the new one is deleted after a failure.
  fs::path log() const { return plan_.cluster() / "upgrade.log"; }

  Result<void> run(const std::vector<std::string>& command, const fs::path& folder = "/") {
    return run_to_end(
        command, user_, log(), [this] { return !progress_.cancelled(); }, folder);
  }

  // Stops the PostgreSQL of an interrupted run, and removes its files.
  Result<void> clear() {
    std::error_code error;
    for (const char* left : {"postgres/pgdata", "copy/postgres/pgdata"})
      if (!end_postmaster(plan_.work() / left, kEndPatience))
        return fail(ErrorCode::conflict, "Database in use",
                    "A PostgreSQL server in " + (plan_.work() / left).string() + " does not stop.");
    fs::remove_all(plan_.work(), error);
    fs::remove(log(), error);
    return give_folder(new_folder(), user_);
  }

  // The copy of a running cluster replaces the old cluster in a rehearsal.
  Result<void> copy_running(const fs::path& folder) {
    progress_.begin_stage(0, 0.2);
    progress_.report(0, "Copying the running cluster");
    STRATA_TRY(give_folder(folder, user_));
    return run({plan_.old_programs / "pg_basebackup",
                "--dbname=" + Cluster::inspect(plan_.data).dsn,
                "--pgdata=" + (folder / "pgdata").string(), "--format=plain", "--wal-method=stream",
                "--checkpoint=fast", "--no-password"});
  }

  // Runs initdb for the new version. pg_upgrade requires that both clusters have checksums, or
  // none.
  Result<void> make_empty_cluster(bool checksums) {
    auto command = initdb_command(plan_.new_programs, new_data());
    if (checksums) command.emplace_back("--data-checksums");
    if (!checksums && plan_.to >= kChecksumsByDefault) command.emplace_back("--no-data-checksums");
    return run(command);
  }

  Result<BackupFacts> make_by_dump(const std::string& dsn) {
    const fs::path dump = plan_.work() / "dump";
    owns_files_ = STRATA_TRY(owns_files(dsn));
    const auto facts = STRATA_TRY(write_backup(dsn, dump, progress_));
    if (old_) STRATA_TRY(old_->stop());
    STRATA_TRY(make_empty_cluster(plan_.to >= kChecksumsByDefault));
    STRATA_TRY(start_new());
    STRATA_TRY(restore_backup(dump, facts, new_->dsn(), progress_));
    STRATA_TRY(finish_new());
    return facts;
  }

  Result<BackupFacts> make_by_upgrade() {
    progress_.begin_stage(0.2, 0.45);
    const auto facts = STRATA_TRY(read_facts(old_->dsn(), progress_));
    owns_files_ = STRATA_TRY(owns_files(old_->dsn()));
    const bool checksums = STRATA_TRY(old_has_checksums());
    STRATA_TRY(old_->stop());
    progress_.begin_stage(0.45, 0.7);
    STRATA_TRY(make_empty_cluster(checksums));
    STRATA_TRY(run_pg_upgrade());
    STRATA_TRY(start_new());
    progress_.begin_stage(0.7, 0.95);
    const auto found = STRATA_TRY(read_facts(new_->dsn(), progress_));
    if (const std::string wrong = difference(facts, found); !wrong.empty())
      return fail(ErrorCode::internal, "Upgraded database differs", "In the new cluster, " + wrong);
    STRATA_TRY(finish_new());
    return facts;
  }

  Result<bool> old_has_checksums() {
    auto connection = STRATA_TRY(PgConnection::connect(old_->dsn()));
    auto row = STRATA_TRY(connection.query("SELECT current_setting('data_checksums') = 'on'"));
    return row.boolean(0, 0);
  }

  Result<void> run_pg_upgrade() {
    progress_.report(0.2, "Copying the data with pg_upgrade");
    // The path of a socket must be short.
    const auto sockets = STRATA_TRY(ScratchFolder::make("upgrade"));
    if (user_.switch_user && chown(sockets.folder().c_str(), user_.uid, user_.gid) != 0)
      return fail(ErrorCode::internal, "Socket folder unavailable",
                  "Cannot change the owner of " + sockets.folder().string() + ".");
    const fs::path old_data = old_->folder() / "pgdata";
    std::vector<std::string> command{plan_.new_programs / "pg_upgrade",
                                     "--old-bindir=" + plan_.old_programs.string(),
                                     "--new-bindir=" + plan_.new_programs.string(),
                                     "--old-datadir=" + old_data.string(),
                                     "--new-datadir=" + new_data().string(),
                                     "--socketdir=" + sockets.folder().string(),
                                     "--username=strata"};
    if (plan_.method == Method::clone) command.emplace_back("--clone");
    const auto done = run(command, new_folder());
    // A pg_upgrade that was killed leaves its postmaster, which is in another process group.
    const bool ended =
        end_postmaster(old_data, kEndPatience) && end_postmaster(new_data(), kEndPatience);
    std::error_code ignored;
    fs::remove(new_folder() / "delete_old_cluster.sh", ignored);  // nobody must run it by mistake
    if (!done) keep_reports();
    if (done && !ended)
      return fail(ErrorCode::internal, "Database in use",
                  "The PostgreSQL server that pg_upgrade has started does not stop.");
    return done;
  }

  // Appends the files in which pg_upgrade explains a failure to the log.
  void keep_reports() const {
    std::error_code error;
    std::ofstream out(log(), std::ios::app);
    for (auto entry = fs::recursive_directory_iterator(new_data() / "pg_upgrade_output.d", error);
         !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
      if (const auto kind = entry->path().extension(); kind == ".log" || kind == ".txt")
        out << "\n--- " << entry->path().filename().string() << "\n"
            << tail(entry->path(), kMaxReportBytes);
  }

  Result<void> start_new() {
    ClusterOptions options;
    options.settings = {"autovacuum=off"};  // `finish_new` runs ANALYZE
    auto cluster = STRATA_TRY(Cluster::start(plan_.work(), options));
    new_ = std::move(cluster);
    return {};
  }

  // Neither pg_upgrade nor pg_restore makes the statistics, without which queries are slow. Call it
  // after the comparison.
  Result<void> finish_new() {
    progress_.begin_stage(0.95, 1);
    progress_.report(0, "Collecting statistics");
    {
      auto connection = STRATA_TRY(PgConnection::connect(new_->dsn(), kMigrationLimits));
      // The new cluster has another identifier.
      if (owns_files_)
        STRATA_TRY(connection.query(sql("UPDATE public.file_store SET owner = ", kDatabaseId,
                                        " || '/' || split_part(owner, '/', 3)")));
      STRATA_TRY(connection.script("ANALYZE"));
    }
    return new_->stop();
  }

  const UpgradePlan& plan_;
  DatabaseUser user_;
  Progress& progress_;
  ScratchFolder work_;  // deleted after the clusters have stopped
  std::unique_ptr<Cluster> old_, new_;
  bool owns_files_ = false;
};

Result<UpgradeReport> upgrade_or_rehearse(const UpgradePlan& plan, bool rehearse,
                                          Progress& progress) {
  const auto begun = std::chrono::steady_clock::now();
  STRATA_TRY(check_space(plan, rehearse));
  const UpgradeLock lock(plan.data);
  if (!lock.taken())
    return fail(ErrorCode::conflict, "Upgrade running",
                "Another upgrade or rehearsal uses " + plan.data.string() + ".");
  auto user = STRATA_TRY(database_user());
  Upgrade upgrade(plan, std::move(user), progress);
  UpgradeReport report;
  std::optional<SpaceWatch> watch;
  if (plan.running) watch.emplace(plan, progress);
  auto made = upgrade.make();
  if (!made && watch && watch->ran_out())
    return fail(ErrorCode::storage_full, "Disk too full",
                "The rehearsal stopped, because the disk of " + plan.data.string() +
                    " was nearly full. The running server needs the rest.");
  if (!made) return tl::unexpected(made.error());
  report.facts = std::move(*made);
  if (!rehearse) STRATA_TRY(upgrade.put_into_place());
  report.took = std::chrono::ceil<std::chrono::seconds>(std::chrono::steady_clock::now() - begun);
  return report;
}

}  // namespace

std::uintmax_t UpgradePlan::needed_bytes(bool rehearse) const {
  const std::uintmax_t copies = method == Method::clone ? 0 : method == Method::copy ? 1 : 2;
  const bool needs_copy = rehearse && running && method != Method::dump;
  // pg_restore writes everything in one transaction, so the new cluster keeps a full log.
  const std::uintmax_t log = method == Method::dump ? std::min(bytes, kMostLogBytes) : 0;
  const std::uintmax_t of_server = rehearse && running ? kBytesOfServer : 0;
  return (copies + (needs_copy ? 1 : 0)) * bytes + log + of_server + kSpareBytes;
}

Result<UpgradePlan> plan_upgrade(const fs::path& data_dir, bool dump) {
  std::error_code error;
  UpgradePlan plan;
  plan.data = fs::absolute(data_dir, error).lexically_normal();
  const auto state = Cluster::inspect(plan.data);
  if (state.version == 0)
    return fail(ErrorCode::not_found, "No database",
                "There is no database in " + plan.data.string() +
                    ". Specify the server's folder with --data.");
  if (state.trouble) return tl::unexpected(*state.trouble);
  const auto user = STRATA_TRY(database_user());
  STRATA_TRY(check_owner(plan.cluster() / "pgdata", user));
  auto old_programs = STRATA_TRY(find_programs(state.version));
  auto new_programs = STRATA_TRY(find_programs(0));
  plan.old_programs = std::move(old_programs);
  plan.new_programs = std::move(new_programs);
  plan.from = state.version;
  plan.to = installed_programs().rbegin()->first;
  plan.running = state.running;
  plan.archived = fs::exists(plan.cluster() / "archive.json", error);
  plan.fallback = plan.data / ("postgres-" + std::to_string(plan.from) + kBeforeUpgrade);
  plan.bytes = size_of(plan.cluster() / "pgdata");
  plan.free_bytes = fs::space(plan.data, error).available;
  if (plan.to <= plan.from) {
    plan.to = plan.from;
    return plan;
  }
  const Method method = STRATA_TRY(choose_method(plan, dump));
  plan.method = method;
  STRATA_TRY(check_same_disk(plan));
  if (fs::exists(plan.fallback, error))
    return fail(ErrorCode::conflict, "Earlier upgrade",
                plan.fallback.string() +
                    " already exists. Delete this folder if you no longer need it, or rename it.");
  return plan;
}

Result<UpgradeReport> rehearse_upgrade(const UpgradePlan& plan, Progress& progress) {
  return upgrade_or_rehearse(plan, true, progress);
}

Result<UpgradeReport> upgrade_cluster(const UpgradePlan& plan, Progress& progress) {
  if (plan.running)
    return fail(ErrorCode::conflict, "Server running",
                "A server uses " + plan.data.string() + ". Stop the server first.");
  return upgrade_or_rehearse(plan, false, progress);
}

}  // namespace strata::store
