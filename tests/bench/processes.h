#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace strata::bench {

// What /proc knows of processes; 0 of those that are not there.
// user and system, of all its threads, also those that have ended
double processor_seconds(pid_t pid);
double family_seconds(pid_t pid);  // and of all that it started
double resident_mib(pid_t pid);
double peak_resident_mib(pid_t pid);  // since `forget_peak`
void forget_peak(pid_t pid);

// A program of the bench's own, which ends with it. What it says goes to `log`.
class ChildProcess {
 public:
  // `command`: the whole path first. Ends the bench when it cannot be started.
  ChildProcess(const std::vector<std::string>& command, std::filesystem::path log);
  ~ChildProcess();  // SIGTERM; SIGKILL where that is not heard within a minute
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  // The rest of the first line that begins with `start`; nothing when the program ends without it,
  // or `limit` is over.
  std::optional<std::string> said(const std::string& start, std::chrono::seconds limit);
  std::string last_words() const;  // the end of the log

 private:
  bool has_ended();
  const std::filesystem::path log_;
  pid_t pid_ = 0;
  bool ended_ = false;
};

// The program of this name that lies on the PATH.
std::optional<std::filesystem::path> on_path(const std::string& program);

}  // namespace strata::bench
