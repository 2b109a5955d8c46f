#include "store/cluster/cluster.h"

#include <fcntl.h>
#include <libpq-fe.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <functional>
#include <future>
#include <mutex>
#include <thread>

#include "core/digest.h"
#include "core/log.h"
#include "core/text/hex.h"
#include "core/text/slug.h"
#include "store/cluster/cluster_process.h"
#include "store/cluster/sql_readers.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr std::size_t kMaxSocketPathLength = 107;  // limit of sockaddr_un
constexpr std::uintmax_t kMaxLog = 16u << 20;

// Returns the folder of the socket: `folder`, or a folder with a short path if the path would be
// too long for a socket.
fs::path socket_folder(const fs::path& folder) {
  if ((folder / ".s.PGSQL.65535.lock").string().size() <= kMaxSocketPathLength) return folder;
  return "/tmp/strata-" + to_hex(sha256(folder.string())).substr(0, 16);
}

constexpr int kUsualPort = 5432;

// Returns the connection string. It contains the port, because PostgreSQL uses the port in the name
// of its socket.
std::string dsn_of(const fs::path& sockets, int port, const std::string& database) {
  return "host=" + dsn_value(sockets.string()) + " port=" + std::to_string(port) +
         " user=strata dbname=" + dsn_value(database);
}

// Returns the port of the postmaster that has the data open, from the fourth line of
// postmaster.pid.
int running_port(const fs::path& data) {
  std::ifstream file(data / "postmaster.pid");
  std::string line;
  for (int i = 0; i < 4; ++i)
    if (!std::getline(file, line)) return kUsualPort;
  return is_all_digits(line) && line.size() <= 5 ? std::stoi(line) : kUsualPort;
}

fs::path postgres_folder(const fs::path& data_dir) {
  std::error_code error;
  return fs::absolute(data_dir, error).lexically_normal() / "postgres";
}

// Finds the programs for the data of a site. If only a newer version is installed, the error names
// the command that updates the data.
Result<fs::path> find_programs_for_data(int major) {
  auto found = find_programs(major);
  if (found || major == 0) return found;
  const auto installed = installed_programs();
  if (!installed.empty() && installed.rbegin()->first > major)
    found.error().detail +=
        " PostgreSQL " + std::to_string(installed.rbegin()->first) +
        " is installed. Install the old version, too, and run `strata upgrade-database`. "
        "Without the old version, restore a backup into a new folder with `strata restore`.";
  return found;
}

// Refuses to create a database while the database of the site has another name. An upgrade that was
// interrupted between its two last steps leaves this state.
Result<void> check_not_set_aside(const fs::path& place) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(place.parent_path(), error))
    if (const std::string name = entry.path().filename();
        name.starts_with("postgres-") && name.ends_with(kBeforeUpgrade))
      return fail(ErrorCode::conflict, "Upgrade interrupted",
                  "The site is in " + entry.path().string() + ", and " + place.string() +
                      " contains no database. Remove " + place.string() +
                      " if it exists, and rename the folder: mv '" + entry.path().string() + "' '" +
                      place.string() + "'.");
  return {};
}

}  // namespace

struct Cluster::Impl {
  fs::path folder;   // data_dir/postgres
  fs::path data;     // folder/pgdata
  fs::path sockets;  // see socket_folder
  fs::path programs;
  fs::path log_file;
  DatabaseUser user;
  ClusterOptions options;
  std::optional<ArchiveFolder> archive;
  int lock_fd = -1;

  // Only the keeper thread forks and waits for child processes; other threads queue tasks for it.
  std::thread keeper;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::packaged_task<Result<void>()>> tasks;
  bool stopping = false;
  bool watching = false;
  std::atomic<pid_t> postmaster{0};

  ~Impl() {
    if (keeper.joinable()) {
      {
        std::lock_guard lock(mutex);
        watching = false;  // do not restart PostgreSQL during the shutdown
      }
      (void)on_keeper([this] { return stop(); });
      {
        std::lock_guard lock(mutex);
        stopping = true;
        changed.notify_all();
      }
      keeper.join();
    }
    if (!sockets.empty() && sockets != folder) rmdir(sockets.c_str());
    if (lock_fd >= 0) close(lock_fd);
  }

  Result<void> on_keeper(std::function<Result<void>()> work) {
    std::packaged_task<Result<void>()> task(std::move(work));
    auto outcome = task.get_future();
    {
      std::lock_guard lock(mutex);
      tasks.push_back(std::move(task));
      changed.notify_all();
    }
    return outcome.get();
  }

  void keep() {
    std::unique_lock lock(mutex);
    while (!stopping) {
      if (tasks.empty()) {
        changed.wait_for(lock, 100ms);
        if (watching && tasks.empty() && !stopping) {
          lock.unlock();
          if (!running()) {
            log::warning("database: the private PostgreSQL stopped, starting it again");
            if (auto started = run(); !started) log::error("database: " + started.error().detail);
          }
          lock.lock();
        }
        continue;
      }
      auto task = std::move(tasks.front());
      tasks.erase(tasks.begin());
      lock.unlock();
      task();
      lock.lock();
    }
  }

  Result<void> prepare(const fs::path& data_dir) {
    auto who = STRATA_TRY(database_user());
    user = std::move(who);
    std::error_code error;
    folder = postgres_folder(data_dir);
    data = folder / "pgdata";
    if (data_version(data) == 0) STRATA_TRY(check_not_set_aside(folder));  // creates nothing
    log_file = folder / "postgres.log";
    STRATA_TRY(give_folder(folder, user));

    lock_fd = open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (lock_fd < 0 || flock(lock_fd, LOCK_EX | LOCK_NB) != 0)
      return fail(ErrorCode::conflict, "Data folder in use",
                  "Another Strata server uses " + data_dir.string() +
                      ". Stop that server, or choose another folder with --data.");

    sockets = socket_folder(folder);
    if (sockets != folder) {
      if (mkdir(sockets.c_str(), 0700) == 0 && user.switch_user &&
          chown(sockets.c_str(), user.uid, user.gid) != 0)
        return fail(ErrorCode::internal, "Socket folder unavailable",
                    "Cannot change the owner of " + sockets.string() + " to " + user.name + ".");
      struct stat info {};
      if (lstat(sockets.c_str(), &info) != 0 || !S_ISDIR(info.st_mode) || info.st_uid != user.uid ||
          (info.st_mode & 077) != 0)
        return fail(ErrorCode::internal, "Socket folder unavailable",
                    sockets.string() + " belongs to another user. Remove it.");
    }
    if (fs::exists(log_file, error) && fs::file_size(log_file, error) > kMaxLog)
      fs::rename(log_file, folder / "postgres.log.1", error);

    const int major = data_version(data);
    auto found = STRATA_TRY(find_programs_for_data(major));
    programs = found;
    if (major == 0) STRATA_TRY(initialise());
    if (!options.archive.empty()) {
      auto claimed = STRATA_TRY(ArchiveFolder::claim(options.archive, folder, user));
      archive = std::move(claimed);
      for (auto& setting : archive->archive_settings())
        options.settings.push_back(std::move(setting));
    }
    return write_access_rules();
  }

  // Writes the access rules. The server connects through the socket, which is in a folder that only
  // the database user can enter. Only analysts connect over TCP.
  Result<void> write_access_rules() {
    std::ofstream file(access_rules(), std::ios::trunc);
    file << "local all all trust\n"
         << "local replication all trust\n";  // for pg_basebackup, which `all` does not include
    if (options.sql)
      for (const char* address : {"127.0.0.1/32", "::1/128"})
        file << "host strata " << kReaderRole << " " << address << " scram-sha-256\n";
    file.close();
    if (!file || chmod(access_rules().c_str(), 0600) != 0 ||
        (user.switch_user && chown(access_rules().c_str(), user.uid, user.gid) != 0))
      return fail(ErrorCode::internal, "Database folder not writable",
                  "Cannot write to " + access_rules().string() + ".");
    return {};
  }
  fs::path access_rules() const { return folder / "access.conf"; }

  // Runs initdb in a folder with another name first, so that an interrupted initdb leaves nothing
  // that looks like a database.
  Result<void> initialise() {
    STRATA_TRY(check_not_set_aside(folder));  // check again, now that the folder is locked
    const fs::path fresh = folder / "pgdata.new";
    std::error_code error;
    fs::remove_all(fresh, error);
    auto child = STRATA_TRY(spawn(initdb_command(programs, fresh), user, log_file, SIGKILL));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (status != 0)
      return fail(ErrorCode::internal, "Database not created",
                  "initdb failed in " + folder.string() + ": " + tail(log_file));
    fs::rename(fresh, data, error);
    if (error)
      return fail(ErrorCode::internal, "Database not created",
                  "Cannot rename " + fresh.string() + ": " + error.message() + ".");
    return {};
  }

  bool running() {
    const pid_t pid = postmaster;
    if (pid <= 0) return false;
    int status = 0;
    const pid_t ended = waitpid(pid, &status, WNOHANG);
    if (ended == 0 || (ended < 0 && errno == EINTR)) return true;
    postmaster = 0;
    return false;
  }

  // Returns true if this process started the running PostgreSQL server. A killed process may have
  // left a PostgreSQL server that has not ended yet.
  bool owns_data() const {
    pid_t owner = 0;
    std::ifstream(data / "postmaster.pid") >> owner;
    return owner == postmaster;
  }

  int port() const { return options.sql ? options.sql->port : kUsualPort; }
  std::string dsn(const std::string& database) const { return dsn_of(sockets, port(), database); }

  std::vector<std::string> postgres_command() const {
    std::vector<std::string> command{
        programs / "postgres",
        "-D",
        data,
        "-k",
        sockets,
        "-p",
        std::to_string(port()),
        "-c",
        "listen_addresses=" + (options.sql ? options.sql->host : std::string()),
        "-c",
        "hba_file=" + access_rules().string(),
        "-c",
        "unix_socket_permissions=0700",
        "-c",
        "jit=off",
        "-c",
        "max_wal_size=2GB",
        "-c",
        "log_timezone=UTC",
        "-c",
        "log_min_messages=warning",
        "-c",
        "logging_collector=off"};
    for (const auto& setting : options.settings) {
      command.push_back("-c");
      command.push_back(setting);
    }
    return command;
  }

  // Starts PostgreSQL. After a `kill -9` of the postmaster, its child processes keep the lock file
  // and the shared memory for some time, so a start that fails immediately is repeated every 100
  // ms.
  Result<void> run() {
    if (running()) return {};
    const auto deadline = Clock::now() + options.patience;
    for (;;) {
      auto child = spawn(postgres_command(), user, log_file, SIGINT);
      if (!child) return tl::unexpected(child.error());
      postmaster = *child;
      // After a crash, PostgreSQL may replay its log for minutes. The wait has no limit, because
      // the replay either succeeds or ends the postmaster. PostgreSQL logs each refused connection,
      // so the pauses grow.
      for (Clock::duration pause = 10ms; running();
           pause = std::min<Clock::duration>(pause * 21 / 20, 1s)) {
        if (owns_data() && PQping(dsn("postgres").c_str()) == PQPING_OK) return {};
        std::this_thread::sleep_for(pause);
      }
      if (Clock::now() >= deadline)
        return fail(ErrorCode::unavailable, "Database not started",
                    "PostgreSQL in " + folder.string() + " did not start: " + tail(log_file));
      // Left by a killed pg_upgrade; later attempts wait for its end.
      end_postmaster(data, 0s, true);
      std::this_thread::sleep_for(100ms);
    }
  }

  // Stops PostgreSQL with a fast shutdown, which ends sessions and writes a checkpoint. If
  // PostgreSQL does not end, sends stronger signals. In that case, the next start recovers the data
  // from the log.
  Result<void> stop() {
    for (const auto& [signal_number, patience] :
         {std::pair{SIGINT, 30s}, std::pair{SIGQUIT, 5s}, std::pair{SIGKILL, 5s}}) {
      if (!running()) return {};
      kill(postmaster, signal_number);
      for (const auto deadline = Clock::now() + patience; running() && Clock::now() < deadline;)
        std::this_thread::sleep_for(5ms);
    }
    if (running())
      log::error("database: PostgreSQL " + std::to_string(postmaster) + " does not end");
    return {};
  }

  Result<void> make_database() {
    auto connection = STRATA_TRY(PgConnection::connect(dsn("postgres")));
    auto known = STRATA_TRY(connection.query("SELECT 1 FROM pg_database WHERE datname = 'strata'"));
    return known.rows() > 0 ? Result<void>{} : connection.script("CREATE DATABASE strata");
  }
};

Cluster::Cluster() : impl_(std::make_unique<Impl>()) {}
Cluster::~Cluster() = default;

Cluster::State Cluster::inspect(const fs::path& data_dir) {
  const fs::path folder = postgres_folder(data_dir);
  State state;
  state.version = data_version(folder / "pgdata");
  state.dsn = dsn_of(socket_folder(folder), running_port(folder / "pgdata"), "strata");
  state.running =
      state.version > 0 && PQping((state.dsn + " connect_timeout=5").c_str()) == PQPING_OK;
  if (auto programs = find_programs_for_data(state.version); !programs)
    state.trouble = programs.error();
  if (auto user = database_user(); !user) state.trouble = user.error();
  return state;
}

Result<std::unique_ptr<Cluster>> Cluster::start(const fs::path& data_dir,
                                                const ClusterOptions& options) {
  std::unique_ptr<Cluster> cluster(new Cluster);
  Impl& impl = *cluster->impl_;
  impl.options = options;
  impl.keeper = std::thread([&impl] { impl.keep(); });
  STRATA_TRY(impl.on_keeper([&]() -> Result<void> {
    if (auto prepared = impl.prepare(data_dir); !prepared) return prepared;
    if (auto running = impl.run(); !running) return running;
    return impl.make_database();
  }));
  return cluster;
}

std::string Cluster::dsn() const { return impl_->dsn("strata"); }
std::string Cluster::dsn(const std::string& database) const { return impl_->dsn(database); }
int Cluster::postmaster_pid() const { return impl_->postmaster; }
const fs::path& Cluster::folder() const { return impl_->folder; }
const std::optional<ArchiveFolder>& Cluster::archive() const { return impl_->archive; }

Result<void> Cluster::ensure_running() {
  return impl_->on_keeper([this] { return impl_->run(); });
}

Result<void> Cluster::stop() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->watching = false;
  }
  return impl_->on_keeper([this] { return impl_->stop(); });
}

void Cluster::watch() {
  std::lock_guard lock(impl_->mutex);
  impl_->watching = true;
  impl_->changed.notify_all();
}

}  // namespace strata::store
