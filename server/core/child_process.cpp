#include "core/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace strata {
namespace {

constexpr int kPollMs = 200;  // the longest time until a cancel is noticed
constexpr std::size_t kLongestLine = 4096, kLongestWords = 2000;

class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { reset(); }
  int get() const { return fd_; }
  void reset(int fd = -1) {
    if (fd_ >= 0) ::close(fd_);
    fd_ = fd;
  }

 private:
  int fd_;
};

struct Pipe {
  Descriptor read, write;
  bool open() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return false;
    read.reset(ends[0]);
    write.reset(ends[1]);
    return true;
  }
};

// Makes only system calls, because other threads may hold the locks of malloc at the time of the
// fork.
[[noreturn]] void become_program(char* const* words, int output, int errors, pid_t parent) {
  setpgid(0, 0);
  for (int number = 1; number < 32; ++number) signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = open("/dev/null", O_RDONLY);
  if (dup2(nothing, 0) < 0 || dup2(output, 1) < 0 || dup2(errors, 2) < 0) _exit(126);
  close_range(3, ~0U, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(126);  // the parent died before prctl
  execv(words[0], words);
  _exit(127);
}

// Cuts the output into lines.
class Lines {
 public:
  explicit Lines(const std::function<void(std::string_view)>& line) : line_(line) {}

  void add(std::string_view text) {
    for (const char c : text) {
      if (c == '\n') {
        line_(begun_);
        begun_.clear();
      } else if (begun_.size() < kLongestLine) {
        begun_ += c;
      }
    }
  }
  void end() {
    if (!begun_.empty()) line_(begun_);
  }

 private:
  const std::function<void(std::string_view)>& line_;
  std::string begun_;
};

// Returns false at the end of the output.
template <class Sink>
bool read_from(const Descriptor& from, const Sink& sink) {
  std::array<char, 4096> buffer;
  const ssize_t count = ::read(from.get(), buffer.data(), buffer.size());
  if (count > 0) sink(std::string_view(buffer.data(), static_cast<std::size_t>(count)));
  return count > 0 || (count < 0 && errno == EINTR);
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

Result<ChildExit> run_child(const std::filesystem::path& program,
                            const std::vector<std::string>& arguments, Progress& progress,
                            const std::function<void(std::string_view line)>& line) {
  if (progress.cancelled()) return cancelled_problem();
  std::string name = program.string();
  std::vector<std::string> copies = arguments;
  std::vector<char*> words{name.data()};
  for (std::string& word : copies) words.push_back(word.data());
  words.push_back(nullptr);

  Pipe output, errors;
  const auto not_started = [&](int reason) {
    return fail(ErrorCode::internal, "Program not started",
                "Cannot start " + name + ": " + std::strerror(reason) + ".");
  };
  if (::access(name.c_str(), X_OK) != 0) return not_started(errno);
  if (!output.open() || !errors.open()) return not_started(errno);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) become_program(words.data(), output.write.get(), errors.write.get(), parent);
  if (child < 0) return not_started(errno);
  output.write.reset();
  errors.write.reset();

  ChildExit exit;
  Lines lines(line);
  bool cancelled = false;
  while (output.read.get() >= 0 || errors.read.get() >= 0) {
    if (!cancelled && progress.cancelled()) {
      cancelled = true;
      if (kill(-child, SIGKILL) != 0) kill(child, SIGKILL);
    }
    pollfd waiting[] = {{output.read.get(), POLLIN, 0}, {errors.read.get(), POLLIN, 0}};
    if (poll(waiting, 2, kPollMs) < 0 && errno != EINTR) break;
    if (waiting[0].revents &&
        !read_from(output.read, [&](std::string_view text) { lines.add(text); }))
      output.read.reset();
    if (waiting[1].revents && !read_from(errors.read, [&](std::string_view text) {
          exit.last_words += text;
          if (exit.last_words.size() > kLongestWords)
            exit.last_words.erase(0, exit.last_words.size() - kLongestWords);
        }))
      errors.read.reset();
  }
  lines.end();
  exit.status = wait_for(child);
  if (cancelled || progress.cancelled()) return cancelled_problem();
  return exit;
}

}  // namespace strata
