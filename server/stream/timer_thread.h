#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace strata::stream {

// One thread that calls functions later. They must be quick. All viewers of the process share it.
class TimerThread {
 public:
  static TimerThread& shared();
  TimerThread();
  ~TimerThread();  // drops waiting calls, joins

  void after(std::chrono::milliseconds delay, std::function<void()> call);

 private:
  using Clock = std::chrono::steady_clock;
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::multimap<Clock::time_point, std::function<void()>> calls_;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses the other members
};

}  // namespace strata::stream
