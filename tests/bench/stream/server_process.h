#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "bench/processes.h"

namespace strata::bench {

// Runs `strata serve` as on a real site: a separate process with a private PostgreSQL, a new data
// folder and a free port of this machine.
class ServerProcess {
 public:
  // `binary`: the path of the server. If the server does not start, prints the end of its log and
  // ends the bench.
  explicit ServerProcess(const std::filesystem::path& binary);
  ~ServerProcess();

  std::uint16_t port() const { return port_; }
  const std::string& token() const { return token_; }  // token of the owner
  std::string renderer() const { return renderer_; }   // as the server's log names it
  const std::filesystem::path& folder() const { return folder_; }
  pid_t pid() const { return process_->pid(); }

  // Processor seconds since the start.
  struct Used {
    double server = 0, postgresql = 0;
  };
  Used used() const;

 private:
  const std::filesystem::path folder_;
  const std::string token_;
  std::unique_ptr<ChildProcess> process_;
  std::uint16_t port_ = 0;
  pid_t postmaster_ = 0;
  std::string renderer_;
};

}  // namespace strata::bench
