#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace strata::bench {

// Measurements of a process from /proc, or 0 if the process does not exist.
// Returns the user and system time of all threads, including threads that have ended.
double processor_seconds(pid_t pid);
double family_seconds(pid_t pid);  // also includes all processes that it started
double resident_mib(pid_t pid);
double peak_resident_mib(pid_t pid);  // since `forget_peak`
void forget_peak(pid_t pid);

// A program that the bench starts and ends. The program's output goes to `log`.
class ChildProcess {
 public:
  // `command` begins with the full path. Ends the bench if the program cannot be started.
  ChildProcess(const std::vector<std::string>& command, std::filesystem::path log);
  ~ChildProcess();  // sends SIGTERM, then SIGKILL if the program still runs after a minute
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  // Waits for a line that begins with `start` and returns the rest of that line. Returns nothing if
  // the program ends without the line, or after `limit`.
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
