#include "store/pg/pool.h"

#include <thread>

namespace strata::store {

Result<Pool::Lease> Pool::acquire(const PgLimits& limits) {
  int outage = 0;
  {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, slot_for_, [&] { return free_slots_ > 0; }))
      return fail(ErrorCode::busy, "Database busy",
                  "All connections to the database are busy. Nothing changed. Try again shortly.");
    --free_slots_;
    outage = outages_;
  }
  auto connection = take(limits);
  if (connection) return Lease(*this, std::move(*connection), outage);
  free_slot();
  return tl::unexpected(connection.error());
}

// Returns an idle connection, or a new one if no connection is idle.
Result<PgConnection> Pool::take(const PgLimits& limits) {
  for (;;) {
    std::unique_lock lock(mutex_);
    if (idle_.empty()) break;
    PgConnection connection = std::move(idle_.back());
    idle_.pop_back();
    lock.unlock();
    if (connection.alive() && connection.set_limits(limits)) return connection;
  }
  const auto deadline = std::chrono::steady_clock::now() + kReconnectFor;
  for (;;) {
    auto connection = PgConnection::connect(dsn_, limits);
    if (connection || std::chrono::steady_clock::now() >= deadline) return connection;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

void Pool::release(PgConnection connection, int outage) {
  if (connection.alive()) {
    std::lock_guard lock(mutex_);
    if (outage == outages_) idle_.push_back(std::move(connection));
  }
  free_slot();
}

void Pool::drop_connections() {
  std::vector<PgConnection> dropped;  // closed after the mutex is released
  std::lock_guard lock(mutex_);
  ++outages_;
  dropped.swap(idle_);
}

void Pool::free_slot() {
  std::lock_guard lock(mutex_);
  ++free_slots_;
  changed_.notify_one();
}

}  // namespace strata::store
