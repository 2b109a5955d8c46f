#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "store/content/trash.h"
#include "store/files/files.h"
#include "store/people/audit.h"

namespace strata::app {

// Erases expired entries of the trash, deletes old rows of the audit log, and sweeps the files
// outside the database, when the server starts and every hour. Erases entries immediately if users
// request it. Works in small steps. If the server stops, it erases the remaining entries after its
// next start.
class TrashPurger {
 public:
  // `trash`, `audit` and `files` must outlive it. If `keep_audit` is 0, the audit log keeps all
  // rows. `keep_files` is the time for which an unused file is kept.
  TrashPurger(store::Trash& trash, std::chrono::days keep, store::Audit& audit,
              std::chrono::days keep_audit, store::Files& files, std::chrono::days keep_files);
  ~TrashPurger() { stop(); }
  void check_now();  // call it when entries must be erased; does not wait
  void stop();       // waits for the current step

 private:
  void run();
  bool is_stopping();
  bool is_interrupted();  // the Trash has work, or the server stops
  Result<bool> empty_trash();
  Result<bool> purge_audit();
  Result<bool> sweep_files();
  Result<void> list_files();

  store::Trash& trash_;
  const std::chrono::days keep_;
  store::Audit& audit_;
  const std::chrono::days keep_audit_;
  store::Files& files_;
  const std::chrono::days keep_files_;
  std::chrono::steady_clock::time_point files_listed_;  // the last time
  bool have_listed_files_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false, must_check_ = true;
  std::thread thread_;
};

}  // namespace strata::app
