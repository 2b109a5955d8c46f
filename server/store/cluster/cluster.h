#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/error.h"

namespace strata::store {

// The server's private PostgreSQL: `initdb` on the first run, by default a Unix socket only,
// stopped with the server (and by the kernel if the server is killed). Any thread may start and use
// it. A separate thread forks the postmaster, because the kernel's "parent died" signal follows the
// thread that forked. cluster_process.cpp describes the other pitfalls.
class Cluster {
 public:
  // The state of a folder. Reading it makes, starts and changes nothing.
  struct State {
    int version = 0;       // major version of the PostgreSQL that made the data; 0: no data yet
    bool running = false;  // a server has the data open; `dsn` connects to it
    std::string dsn;
    std::optional<Error> trouble;  // why it cannot be started
  };
  static State inspect(const std::filesystem::path& data_dir);

  // TCP for analysts, in addition to the socket: an address of this machine's loopback. Only the
  // role kReaderRole may connect, with its password (scram-sha-256).
  struct SqlListen {
    std::string host;  // without brackets
    int port = 0;      // 1…65535
  };

  // Keeps everything in `data_dir`/postgres. `data_dir` must be reachable by the database user when
  // the server runs as root; the error contains the remedy. A second server on the same folder is
  // refused (conflict).
  static Result<std::unique_ptr<Cluster>> start(const std::filesystem::path& data_dir,
                                                const std::optional<SqlListen>& sql = {});
  ~Cluster();  // fast shutdown, waits
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  // of the database "strata", made at the first start
  std::string dsn() const;
  std::string dsn(const std::string& database) const;  // of another database
  int postmaster_pid() const;
  // Restarts the postmaster if it has died (tested by killing it); quick when it is alive.
  Result<void> ensure_running();
  // From now on, restarts the postmaster automatically when it dies.
  void watch();

 private:
  Cluster();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
