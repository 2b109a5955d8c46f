#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "store/cluster/archive_folder.h"

namespace strata::store {

// An address where analysts connect over TCP, in addition to the socket. It is on the loopback
// interface of this machine. Only the role kReaderRole may connect, with its password
// (scram-sha-256).
struct SqlListen {
  std::string host;  // without brackets
  int port = 0;      // 1…65535
};

struct ClusterOptions {
  std::optional<SqlListen> sql{};
  std::filesystem::path archive{};      // PostgreSQL archives its WAL there; empty: no archive
  std::vector<std::string> settings{};  // more settings of PostgreSQL: `name=value`
  // The time during which a start that fails immediately is repeated. Processes of a killed server
  // may still use the data.
  std::chrono::seconds patience{30};
};

// `strata upgrade-database` renames the folder `postgres` of the old version to
// `postgres-N-before-upgrade`.
inline constexpr const char* kBeforeUpgrade = "-before-upgrade";

// The private PostgreSQL of the server. The first start runs `initdb`. By default, PostgreSQL
// listens on a Unix socket only. It stops with the server, or the kernel stops it if the server is
// killed. Any thread may start and use it. A separate thread forks the postmaster, because the
// "parent died" signal of the kernel depends on the thread that forked. cluster_process.cpp
// describes the other pitfalls.
class Cluster {
 public:
  // The state of a folder. `inspect` does not create, start or change anything.
  struct State {
    // major version of the PostgreSQL that made the data; 0 if there is no data yet
    int version = 0;
    bool running = false;  // a server has the data open; `dsn` connects to it
    std::string dsn;
    std::optional<Error> trouble;  // the reason why it cannot be started
  };
  static State inspect(const std::filesystem::path& data_dir);

  // Keeps all files in `data_dir`/postgres. If the server runs as root, the database user must be
  // able to reach `data_dir`; otherwise the error explains the remedy. Returns a `conflict` error
  // if another server uses the folder.
  static Result<std::unique_ptr<Cluster>> start(const std::filesystem::path& data_dir,
                                                const ClusterOptions& options = {});
  ~Cluster();  // waits for a fast shutdown
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  // Returns the connection string of the database "strata", which the first start creates.
  std::string dsn() const;
  std::string dsn(const std::string& database) const;  // connection string of another database
  int postmaster_pid() const;
  const std::filesystem::path& folder() const;          // `data_dir`/postgres
  const std::optional<ArchiveFolder>& archive() const;  // of ClusterOptions::archive
  // Restarts the postmaster if it has died (tests kill it). Returns quickly if it is running.
  Result<void> ensure_running();
  // Stops PostgreSQL. The folder stays locked until this object is destroyed, so no other process
  // opens the data.
  Result<void> stop();
  // Begins to watch the postmaster, and restarts it when it dies.
  void watch();

 private:
  Cluster();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
