#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace strata::bench {

// Figures of processes from /proc; 0 for processes that do not exist.
// user and system time of all threads, also of ended ones
double processor_seconds(pid_t pid);
double family_seconds(pid_t pid);  // in addition those of all processes that it started
double resident_mib(pid_t pid);
double peak_resident_mib(pid_t pid);  // since `forget_peak`
void forget_peak(pid_t pid);

// A program that the bench starts, and that ends with it. Its output goes to `log`.
class ChildProcess {
 public:
  // `command` begins with the full path. Ends the bench if the program cannot be started.
  ChildProcess(const std::vector<std::string>& command, std::filesystem::path log);
  ~ChildProcess();  // SIGTERM; SIGKILL if it has not ended after a minute
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  // Returns the rest of the first line that begins with `start`; nothing if the program ends
  // without it, or after `limit`.
  std::optional<std::string> said(const std::string& start, std::chrono::seconds limit);
  std::string last_words() const;  // the end of the log

 private:
  bool has_ended();
  const std::filesystem::path log_;
  pid_t pid_ = 0;
  bool ended_ = false;
};

// Returns the program of this name on the PATH.
std::optional<std::filesystem::path> on_path(const std::string& program);

}  // namespace strata::bench
