#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "store/content/trash.h"
#include "store/people/audit.h"

namespace strata::app {

// Erases expired entries of the trash, and deletes old rows of the audit log, when the server
// starts and every hour. Erases entries immediately if users request it. Works in small steps. If
// the server stops, it erases the remaining entries after its next start.
class TrashPurger {
 public:
  // `trash` and `audit` must outlive it. If `keep_audit` is 0, the audit log keeps all rows.
  TrashPurger(store::Trash& trash, std::chrono::days keep, store::Audit& audit,
              std::chrono::days keep_audit);
  ~TrashPurger() { stop(); }
  void check_now();  // call it when entries must be erased; does not wait
  void stop();       // waits for the current step

 private:
  void run();
  bool is_stopping();
  Result<bool> empty_trash();
  Result<bool> purge_audit();

  store::Trash& trash_;
  const std::chrono::days keep_;
  store::Audit& audit_;
  const std::chrono::days keep_audit_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false, must_check_ = true;
  std::thread thread_;
};

}  // namespace strata::app
