#pragma once

#include <signal.h>

#include <atomic>
#include <ctime>
#include <thread>

#include "core/progress.h"

namespace strata::cli {

// Cancels the work on SIGTERM, SIGINT and SIGHUP, so that it can stop its programs and delete its
// folder. The threads of the work inherit the signal mask, so create this object first.
class CancelBySignal {
 public:
  explicit CancelBySignal(Progress& progress) {
    sigset_t ending;
    sigemptyset(&ending);
    for (const int number : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&ending, number);
    pthread_sigmask(SIG_BLOCK, &ending, &before_);
    thread_ = std::thread([this, ending, &progress] {
      const timespec pause{0, 100'000'000};
      while (!done_)
        if (sigtimedwait(&ending, nullptr, &pause) > 0) progress.cancel();
    });
  }
  ~CancelBySignal() {
    done_ = true;
    thread_.join();
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  CancelBySignal(const CancelBySignal&) = delete;
  CancelBySignal& operator=(const CancelBySignal&) = delete;

 private:
  sigset_t before_{};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace strata::cli
