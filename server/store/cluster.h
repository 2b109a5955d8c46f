#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/problem.h"

namespace strata::store {

// The server's own PostgreSQL: `initdb` on first run, unix socket only, stopped with the server (and by the kernel if the
// server is killed). Start it from the main thread. See STACK notes in cluster.cpp for the traps.
class Cluster {
 public:
  // `data_dir` must be reachable by the database user when the server runs as root; the error says what to do.
  static Result<std::unique_ptr<Cluster>> start(const std::filesystem::path& data_dir);
  ~Cluster();  // fast shutdown, waits

  std::string dsn() const;
  int postmaster_pid() const;
  // Starts it again when the postmaster has died (tested by killing it); quick when it is alive.
  Result<void> ensure_running();

 private:
  Cluster();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
