#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "store/content/trash.h"

namespace strata::app {

// Erases expired entries of the trash when the server starts and every hour. Erases entries
// immediately if users request it. Works in small steps. If the server stops, it erases the
// remaining entries after its next start.
class TrashPurger {
 public:
  TrashPurger(store::Trash& trash, std::chrono::days keep);  // `trash` must outlive it
  ~TrashPurger() { stop(); }
  void check_now();  // call it when entries must be erased; does not wait
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
