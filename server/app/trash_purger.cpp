#include "app/trash_purger.h"

#include "core/log.h"

namespace strata::app {
namespace {

constexpr std::chrono::hours kBetweenLooks{1};
constexpr std::chrono::minutes kAfterFailure{1};  // the database may be reachable by then

}  // namespace

TrashPurger::TrashPurger(store::Trash& trash, std::chrono::days keep)
    : trash_(trash), keep_(keep), thread_([this] { run(); }) {}

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

void TrashPurger::run() {
  std::chrono::minutes pause = kBetweenLooks;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, pause, [this] { return stopping_ || must_check_; });
      if (stopping_) return;
      must_check_ = false;
    }
    auto expired = trash_.expire(keep_);
    Result<bool> some = expired ? Result<bool>(true) : tl::unexpected(expired.error());
    while (some && *some && !is_stopping()) some = trash_.erase_some();
    pause = some ? std::chrono::minutes(kBetweenLooks) : kAfterFailure;
    if (!some && !is_stopping())
      log::warning("the server could not empty the Trash and will try again: " +
                   some.error().detail);
  }
}

}  // namespace strata::app
