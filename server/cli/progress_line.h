#pragma once

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>

#include "core/progress.h"

namespace strata::cli {

// Shows a Progress on stderr during its lifetime. On a terminal, it rewrites one line. Otherwise,
// it prints one line per step.
class ProgressLine {
 public:
  explicit ProgressLine(const Progress& progress)
      : progress_(progress), thread_([this] { watch(); }) {}
  ~ProgressLine() {
    {
      std::lock_guard lock(mutex_);
      done_ = true;
      changed_.notify_all();
    }
    thread_.join();
  }

 private:
  void watch() {
    const bool terminal = isatty(STDERR_FILENO);
    std::string last;
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, std::chrono::milliseconds(200), [&] { return done_; })) {
      const std::string message = progress_.message();
      const int percent = static_cast<int>(progress_.fraction() * 100);
      if (terminal)
        std::fprintf(stderr, "\r\033[K%3d %% %s", percent, message.c_str());
      else if (message != last)
        std::fprintf(stderr, "%3d %% %s\n", percent, message.c_str());
      last = message;
      std::fflush(stderr);
    }
    if (terminal && !last.empty()) std::fprintf(stderr, "\r\033[K");
  }
  const Progress& progress_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::thread thread_;
};

}  // namespace strata::cli
