#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "store/content/trash.h"

namespace strata::app {

// Erases what has been in the Trash for long enough, at start and every hour, and at once what
// people erase, in small steps that nobody waits for. What is left when the server ends goes on at
// its next start.
class TrashPurger {
 public:
  TrashPurger(store::Trash& trash, std::chrono::days keep);  // the Trash must outlive it
  ~TrashPurger() { stop(); }
  void check_now();  // something is there to be erased; does not wait
  void stop();       // waits for the step that is under way

 private:
  void run();
  bool is_stopping();

  store::Trash& trash_;
  const std::chrono::days keep_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false, must_check_ = true;
  std::thread thread_;
};

}  // namespace strata::app
