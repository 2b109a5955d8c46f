#include "store/cluster/cluster_process.h"

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <thread>

#include "core/progress.h"
#include "core/text/slug.h"

extern char** environ;

namespace strata::store {
namespace fs = std::filesystem;

Result<DatabaseUser> database_user() {
  DatabaseUser user;
  user.uid = geteuid();
  user.gid = getegid();
  if (user.uid != 0) {
    user.name = "this user";
    return user;
  }
  const passwd* entry = getpwnam("postgres");
  if (!entry)
    return fail(ErrorCode::internal, "No database user",
                "PostgreSQL does not run as root, and there is no user `postgres`. Install "
                "postgresql, run Strata as another user, or use --database.");
  user.switch_user = true;
  user.name = entry->pw_name;
  user.uid = entry->pw_uid;
  user.gid = entry->pw_gid;
  int count = 64;
  user.groups.resize(count);
  if (getgrouplist(entry->pw_name, entry->pw_gid, user.groups.data(), &count) < 0) count = 64;
  user.groups.resize(count);
  return user;
}

namespace {

std::string program_folders() {
  const char* listed = std::getenv("STRATA_POSTGRESQL");
  return listed && *listed ? listed : "/usr/lib/postgresql";
}

std::vector<fs::path> parts_of_list(std::string list) {
  std::vector<fs::path> parts;
  while (!list.empty()) {
    const std::string part = list.substr(0, list.find(':'));
    list.erase(0, std::min(list.size(), part.size() + 1));
    if (!part.empty()) parts.emplace_back(part);
  }
  return parts;
}

}  // namespace

std::map<int, fs::path> installed_programs() {
  std::map<int, fs::path> found;
  std::error_code error;
  for (const fs::path& folder : parts_of_list(program_folders()))
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      const std::string version = entry.path().filename();
      if (is_all_digits(version) && version.size() <= 3 &&
          fs::exists(entry.path() / "bin/postgres", error))
        found.emplace(std::stoi(version), entry.path() / "bin");
    }
  return found;
}

Result<fs::path> find_programs(int expected_major) {
  const auto installed = installed_programs();
  if (expected_major == 0 && !installed.empty()) return installed.rbegin()->second;
  if (const auto same = installed.find(expected_major); same != installed.end())
    return same->second;
  std::error_code error;
  if (const char* path = std::getenv("PATH"); path && expected_major == 0)
    for (const fs::path& folder : parts_of_list(path))
      if (fs::exists(folder / "postgres", error) && fs::exists(folder / "initdb", error))
        return folder;
  const std::string number = expected_major ? std::to_string(expected_major) : "";
  return fail(ErrorCode::internal, "PostgreSQL missing",
              "PostgreSQL" + (expected_major ? " " + number + ", which wrote the data," : number) +
                  " is not installed (Strata searched for N/bin in " + program_folders() +
                  "). Install postgresql" + (expected_major ? "-" + number : number) +
                  ", or use --database.");
}

int data_version(const fs::path& pgdata) {
  int major = 0;
  if (std::ifstream version(pgdata / "PG_VERSION"); version) version >> major;
  return major;
}

std::vector<std::string> initdb_command(const fs::path& programs, const fs::path& pgdata) {
  return {programs / "initdb",
          "-D",
          pgdata,
          "-U",
          "strata",
          "-A",
          "trust",
          "-E",
          "UTF8",
          "--locale=C.UTF-8",
          "--no-instructions"};
}

namespace {

// pg_upgrade starts PostgreSQL with the option -b.
bool is_of_upgrade(pid_t pid) {
  std::ifstream command("/proc/" + std::to_string(pid) + "/cmdline", std::ios::binary);
  for (std::string word; std::getline(command, word, '\0');)
    if (word == "-b") return true;
  return false;
}

}  // namespace

bool end_postmaster(const fs::path& pgdata, std::chrono::seconds patience, bool only_of_upgrade) {
  pid_t pid = 0;
  std::ifstream(pgdata / "postmaster.pid") >> pid;
  if (pid <= 1) return true;
  std::error_code error;
  const fs::path data = fs::canonical(pgdata, error);
  // A later process can have the same process id, but not the data folder as working directory.
  const fs::path place = "/proc/" + std::to_string(pid) + "/cwd";
  const auto ended = [&] {
    std::error_code gone;
    return fs::read_symlink(place, gone) != data || gone;
  };
  if (ended()) return true;
  if (only_of_upgrade && !is_of_upgrade(pid)) return false;
  kill(pid, SIGINT);  // a fast shutdown, which writes a checkpoint
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!ended()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

namespace {

// Makes only system calls, because other threads may hold the locks of malloc and stdio at the time
// of the fork.
bool become(const DatabaseUser& user) {
  if (!user.switch_user) return true;
  return setgroups(user.groups.size(), user.groups.data()) == 0 && setgid(user.gid) == 0 &&
         setuid(user.uid) == 0;
}

}  // namespace

Result<void> give_folder(const fs::path& folder, const DatabaseUser& user) {
  std::error_code error;
  // The database user can enter every folder that is made here. The permissions of the inner
  // folders protect the content.
  fs::path made;
  for (const auto& part : folder) {
    made /= part;
    if (fs::exists(made, error)) continue;
    if (mkdir(made.c_str(), 0755) != 0 && errno != EEXIST)
      return fail(ErrorCode::internal, "Data folder unavailable",
                  "Cannot create " + made.string() + ": " + std::strerror(errno) + ".");
    chmod(made.c_str(), 0755);
  }
  struct stat info {};
  if (lstat(folder.c_str(), &info) != 0 || !S_ISDIR(info.st_mode))
    return fail(ErrorCode::internal, "Data folder unavailable",
                folder.string() + " is not a folder.");
  if ((user.switch_user && info.st_uid != user.uid &&
       chown(folder.c_str(), user.uid, user.gid) != 0) ||
      chmod(folder.c_str(), 0700) != 0)
    return fail(ErrorCode::internal, "Data folder unavailable",
                "Cannot change the owner of " + folder.string() + " to " + user.name + ": " +
                    std::strerror(errno) + ".");

  const pid_t child = fork();
  if (child == 0) _exit(become(user) && chdir(folder.c_str()) == 0 ? 0 : 1);
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (child < 0 || status != 0)
    return fail(
        ErrorCode::internal, "Data folder not reachable",
        "The database runs as user `" + user.name + "`, which cannot access " + folder.string() +
            ". Choose a data folder outside private home folders, such as /var/lib/strata, or "
            "allow this user to pass through the parent folders (chmod o+x).");
  return {};
}

Result<pid_t> spawn(const std::vector<std::string>& command, const DatabaseUser& user,
                    const fs::path& log, int death_signal, const fs::path& folder) {
  std::vector<char*> arguments;
  for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  std::vector<char*> environment;
  // leave out variables such as PGDATA and PGPORT, which are meant for other programs
  for (char** variable = environ; *variable; ++variable)
    if (std::strncmp(*variable, "PG", 2) != 0) environment.push_back(*variable);
  environment.push_back(nullptr);

  const int output = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0640);
  if (output < 0)
    return fail(ErrorCode::internal, "Data folder unavailable",
                "Cannot write to " + log.string() + ": " + std::strerror(errno));
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) {
    setpgid(0, 0);
    for (int signal_number = 1; signal_number < 32; ++signal_number) signal(signal_number, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    const int nothing = open("/dev/null", O_RDONLY);
    if (dup2(nothing, 0) < 0 || dup2(output, 1) < 0 || dup2(output, 2) < 0) _exit(126);
    for (int fd = 3; fd < 4096; ++fd) close(fd);
    if (!become(user)) _exit(126);
    prctl(PR_SET_PDEATHSIG, death_signal);  // after setuid, which clears this setting
    if (getppid() != parent) _exit(126);    // the parent died before prctl
    umask(0077);
    if (chdir(folder.c_str()) != 0) _exit(126);
    execve(arguments[0], arguments.data(), environment.data());
    _exit(127);
  }
  close(output);
  if (child < 0)
    return fail(ErrorCode::internal, "Database not started",
                std::string("Cannot fork: ") + std::strerror(errno));
  return child;
}

Result<void> run_to_end(const std::vector<std::string>& command, const DatabaseUser& user,
                        const fs::path& log, const std::function<bool()>& goes_on,
                        const fs::path& folder) {
  const auto child = STRATA_TRY(spawn(command, user, log, SIGKILL, folder));
  int status = 0;
  bool cancelled = false;
  for (;;) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child || (ended < 0 && errno != EINTR)) break;
    if (!goes_on()) {
      cancelled = true;
      kill(child, SIGKILL);
      kill(-child, SIGKILL);  // the process group
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  if (cancelled) return cancelled_problem();
  if (status == 0) return {};
  const std::string name = fs::path(command.front()).filename();
  const std::string said = tail(log);
  const bool full = said.find("No space left") != std::string::npos ||
                    said.find("File too large") != std::string::npos;
  if (full) return fail(ErrorCode::storage_full, "Disk full", name + ": " + said);
  return fail(ErrorCode::internal, "Command failed", name + " failed: " + said);
}

std::string dsn_value(std::string_view value) {
  std::string out = "'";
  for (const char c : value) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

std::string tail(const fs::path& file, std::size_t bytes) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return {};
  const auto size = static_cast<std::size_t>(in.tellg());
  const std::size_t start = size > bytes ? size - bytes : 0;
  std::string text(size - start, '\0');
  in.seekg(static_cast<std::streamoff>(start));
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  return text;
}

}  // namespace strata::store
