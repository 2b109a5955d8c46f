#include "app/trash_purger.h"

#include "core/log.h"

namespace strata::app {
namespace {

constexpr std::chrono::hours kBetweenLooks{1};
constexpr std::chrono::minutes kAfterFailure{1};  // the database may be reachable by then
constexpr std::chrono::hours kBetweenLists{24};   // a list of all files is expensive in a bucket

}  // namespace

TrashPurger::TrashPurger(store::Trash& trash, std::chrono::days keep, store::Audit& audit,
                         std::chrono::days keep_audit, store::Files& files,
                         std::chrono::days keep_files)
    : trash_(trash),
      keep_(keep),
      audit_(audit),
      keep_audit_(keep_audit),
      files_(files),
      keep_files_(keep_files),
      thread_([this] { run(); }) {}

void TrashPurger::check_now() {
  const std::lock_guard lock(mutex_);
  must_check_ = true;
  wake_.notify_all();
}

void TrashPurger::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool TrashPurger::is_stopping() {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

bool TrashPurger::is_interrupted() {
  const std::lock_guard lock(mutex_);
  return stopping_ || must_check_;
}

// These functions return false when they are done, and true if the server stops before that.
Result<bool> TrashPurger::empty_trash() {
  STRATA_TRY(trash_.expire(keep_));
  Result<bool> some = true;
  while (some && *some && !is_stopping()) some = trash_.erase_some();
  return some;
}

Result<bool> TrashPurger::purge_audit() {
  Result<bool> some = keep_audit_.count() > 0;
  while (some && *some && !is_stopping()) some = audit_.purge_some(keep_audit_);
  return some;
}

Result<bool> TrashPurger::sweep_files() {
  const auto interrupted = [this] { return is_interrupted(); };
  Result<bool> some = true;
  while (some && *some && !is_interrupted())
    some = files_.sweep(keep_files_, store::Files::kRest, interrupted);
  // Without the right to list a bucket, the server still deletes unused files.
  if (const auto listed = list_files(); !listed && some) return tl::unexpected(listed.error());
  return some;
}

Result<void> TrashPurger::list_files() {
  const auto now = std::chrono::steady_clock::now();
  if (is_interrupted() || (have_listed_files_ && now - files_listed_ < kBetweenLists)) return {};
  const auto listed = files_.find_superfluous([this] { return is_interrupted(); });
  if (!listed && listed.error().code == ErrorCode::cancelled) return {};  // begins again soon
  files_listed_ = now;
  have_listed_files_ = true;
  return listed;
}

void TrashPurger::run() {
  std::chrono::minutes pause = kBetweenLooks;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, pause, [this] { return stopping_ || must_check_; });
      if (stopping_) return;
      must_check_ = false;
    }
    const auto emptied = empty_trash();
    const auto purged = purge_audit();
    const auto swept = sweep_files();
    pause = emptied && purged && swept ? std::chrono::minutes(kBetweenLooks) : kAfterFailure;
    if (is_stopping()) continue;
    if (!emptied)
      log::warning("the server could not empty the Trash and will try again: " +
                   emptied.error().detail);
    if (!purged)
      log::warning("the server could not delete old rows of the audit log and will try again: " +
                   purged.error().detail);
    if (!swept)
      log::warning("the server could not delete unused files and will try again: " +
                   swept.error().detail);
  }
}

}  // namespace strata::app
