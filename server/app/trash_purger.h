#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "store/content/trash.h"

namespace strata::app {

// Erases the entries of the trash that have expired, at start and every hour, and at once those
// that people erase, in small steps. When the server stops, the rest waits for its next start.
class TrashPurger {
 public:
  TrashPurger(store::Trash& trash, std::chrono::days keep);  // the Trash must outlive it
  ~TrashPurger() { stop(); }
  void check_now();  // call when entries are to be erased; does not wait
  void stop();       // waits for the current step

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
