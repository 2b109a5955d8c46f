#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/error.h"

namespace strata::store {

// The server's own PostgreSQL: `initdb` on first run, unix socket only, stopped with the server
// (and by the kernel if the server is killed). Any thread may start and use it: a thread of its own
// forks the postmaster, because the kernel's "parent died" signal follows the thread that forked.
// See cluster_process.cpp for the other traps.
class Cluster {
 public:
  // What a folder holds, without making, starting or changing anything.
  struct State {
    int version = 0;       // major, of the PostgreSQL that made the data; 0: there is none yet
    bool running = false;  // a server has it open; `dsn` leads there
    std::string dsn;
    std::optional<Error> trouble;  // why it cannot be started
  };
  static State inspect(const std::filesystem::path& data_dir);

  // TCP for analysts, beside the socket: an address of this machine's loopback, on which the role
  // kReaderRole alone may connect, with its password (scram-sha-256).
  struct SqlListen {
    std::string host;  // without brackets
    int port = 0;      // 1…65535
  };

  // Everything lies in `data_dir`/postgres. `data_dir` must be reachable by the database user when
  // the server runs as root; the error says what to do. A second server on the same folder is
  // refused (conflict).
  static Result<std::unique_ptr<Cluster>> start(const std::filesystem::path& data_dir,
                                                const std::optional<SqlListen>& sql = {});
  ~Cluster();  // fast shutdown, waits
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  // of the database "strata", made at the first start
  std::string dsn() const;
  std::string dsn(const std::string& database) const;  // of another one
  int postmaster_pid() const;
  // Starts it again when the postmaster has died (tested by killing it); quick when it is alive.
  Result<void> ensure_running();
  // From now on it is started again without being asked whenever it dies.
  void watch();

 private:
  Cluster();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
