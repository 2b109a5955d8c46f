#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace strata::stream {

// One thread that calls functions after a delay. The functions must return quickly. All viewers of
// the process share this thread.
class TimerThread {
 public:
  static TimerThread& shared();
  TimerThread();
  ~TimerThread();  // drops waiting calls and joins the thread

  void after(std::chrono::milliseconds delay, std::function<void()> call);

 private:
  using Clock = std::chrono::steady_clock;
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::multimap<Clock::time_point, std::function<void()>> calls_;
  bool stopping_ = false;
  std::thread thread_;  // the last member, because it uses the others
};

}  // namespace strata::stream
