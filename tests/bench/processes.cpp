#include "bench/processes.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>
#include <thread>

#include "bench/harness.h"
#include "store/cluster/cluster_process.h"

namespace strata::bench {
namespace {

namespace fs = std::filesystem;

// Returns the fields of /proc/PID/stat that follow the name, beginning with the state: proc(5).
std::vector<std::string> stat_fields(const fs::path& process) {
  std::ifstream file(process / "stat");
  std::string line;
  std::getline(file, line);
  const auto name_end = line.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream rest(line.substr(name_end + 1));
  std::vector<std::string> fields;
  for (std::string field; rest >> field;) fields.push_back(field);
  return fields.size() < 15 ? std::vector<std::string>() : fields;
}

// Returns the sum of `count` fields beginning with utime: user and system time, then both times of
// the children that the process waited for.
double seconds_of(const std::vector<std::string>& fields, int count) {
  if (fields.empty()) return 0;
  const auto first = fields.begin() + 11;
  const double ticks =
      std::accumulate(first, first + count, 0.0,
                      [](double sum, const std::string& field) { return sum + std::stod(field); });
  return ticks / double(sysconf(_SC_CLK_TCK));
}

double status_mib(pid_t pid, const std::string& key) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key + ":")) return std::stod(line.substr(key.size() + 1)) / 1024;
  return 0;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

double processor_seconds(pid_t pid) {
  return seconds_of(stat_fields("/proc/" + std::to_string(pid)), 2);
}

double family_seconds(pid_t pid) {
  std::map<pid_t, pid_t> parents;
  std::map<pid_t, double> seconds;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (!is_number(name)) continue;
    const auto fields = stat_fields(entry.path());
    if (fields.empty()) continue;  // the process has ended since the listing
    parents[std::stoi(name)] = std::stoi(fields[1]);
    seconds[std::stoi(name)] = seconds_of(fields, 4);
  }
  double sum = 0;
  for (const auto& [each, used] : seconds) {
    pid_t of = each;
    while (of != pid && parents.contains(of)) of = parents[of];
    if (of == pid) sum += used;
  }
  return sum;
}

double resident_mib(pid_t pid) { return status_mib(pid, "VmRSS"); }
double peak_resident_mib(pid_t pid) { return status_mib(pid, "VmHWM"); }
void forget_peak(pid_t pid) {
  std::ofstream("/proc/" + std::to_string(pid) + "/clear_refs") << "5";
}

ChildProcess::ChildProcess(const std::vector<std::string>& command, fs::path log)
    : log_(std::move(log)), pid_(must(store::spawn(command, {}, log_, SIGTERM))) {}

ChildProcess::~ChildProcess() {
  if (has_ended()) return;
  kill(pid_, SIGTERM);
  const double limit_ms = now_ms() + 60e3;
  while (!has_ended() && now_ms() < limit_ms)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  if (has_ended()) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

bool ChildProcess::has_ended() {
  ended_ = ended_ || waitpid(pid_, nullptr, WNOHANG) != 0;
  return ended_;
}

std::optional<std::string> ChildProcess::said(const std::string& start,
                                              std::chrono::seconds limit) {
  const double limit_ms = now_ms() + std::chrono::duration<double, std::milli>(limit).count();
  while (true) {
    const bool is_last_surface_image = has_ended() || now_ms() > limit_ms;
    std::ifstream log(log_);
    // A line without an end of line is still incomplete.
    for (std::string line; std::getline(log, line) && !log.eof();)
      if (line.starts_with(start)) return line.substr(start.size());
    if (is_last_surface_image) return std::nullopt;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

std::string ChildProcess::last_words() const { return store::tail(log_, 4000); }

std::optional<fs::path> on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path file = fs::path(folder) / program; access(file.c_str(), X_OK) == 0)
      return file;
  return std::nullopt;
}

}  // namespace strata::bench
