#include "stream/timer_thread.h"

#include <utility>

namespace strata::stream {

TimerThread& TimerThread::shared() {
  static TimerThread timer;
  return timer;
}

TimerThread::TimerThread() : thread_([this] { run(); }) {}

TimerThread::~TimerThread() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void TimerThread::after(std::chrono::milliseconds delay, std::function<void()> call) {
  std::lock_guard lock(mutex_);
  if (stopping_) return;
  const auto added = calls_.emplace(Clock::now() + delay, std::move(call));
  if (added == calls_.begin()) changed_.notify_all();
}

void TimerThread::run() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (calls_.empty()) {
      changed_.wait(lock);
    } else if (const auto due = calls_.begin()->first; due > Clock::now()) {
      changed_.wait_until(lock, due);
    } else {
      auto call = std::move(calls_.extract(calls_.begin()).mapped());
      lock.unlock();
      call();
      call = nullptr;  // destroys captured objects outside the lock
      lock.lock();
    }
  }
}

}  // namespace strata::stream
