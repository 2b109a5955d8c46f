#include "store/pool.h"

#include <thread>

namespace strata::store {

Result<Pool::Lease> Pool::acquire(std::chrono::milliseconds reconnect_for) {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return free_slots_ > 0; });
    --free_slots_;
    while (!idle_.empty()) {
      PgConnection connection = std::move(idle_.back());
      idle_.pop_back();
      if (connection.alive()) return Lease(*this, std::move(connection));
    }
  }
  const auto deadline = std::chrono::steady_clock::now() + reconnect_for;
  for (;;) {
    auto connection = PgConnection::connect(dsn_);
    if (connection) return Lease(*this, std::move(*connection));
    if (std::chrono::steady_clock::now() >= deadline) {
      std::lock_guard lock(mutex_);
      ++free_slots_;
      changed_.notify_one();
      return tl::unexpected(connection.error());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

void Pool::release(PgConnection connection) {
  const bool usable = connection.alive();
  std::lock_guard lock(mutex_);
  if (usable) idle_.push_back(std::move(connection));
  ++free_slots_;
  changed_.notify_one();
}

}  // namespace strata::store
