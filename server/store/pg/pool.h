#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "store/pg/acting.h"
#include "store/pg/pg.h"

namespace strata::store {

// Connections shared by threads. A caller waits at most `slot_for` for a free connection, and then
// gets an `unavailable` error. Broken connections are replaced. If the database is unreachable, the
// pool tries to connect for `kReconnectFor` (about the time of a restart) before it returns an
// `unavailable` error.
class Pool {
 public:
  static constexpr std::chrono::milliseconds kReconnectFor{3000};

  Pool(std::string dsn, int size, PgLimits limits, std::chrono::milliseconds slot_for)
      : dsn_(std::move(dsn)), limits_(limits), slot_for_(slot_for), free_slots_(size) {}

  const std::string& dsn() const { return dsn_; }

  class Lease {
   public:
    Lease(Pool& pool, PgConnection connection, int outage)
        : pool_(&pool), connection_(std::move(connection)), outage_(outage) {}
    Lease(Lease&& other) noexcept
        : pool_(std::exchange(other.pool_, nullptr)),
          connection_(std::move(other.connection_)),
          outage_(other.outage_) {}
    Lease& operator=(Lease&&) = delete;
    ~Lease() {
      if (pool_) pool_->release(std::move(connection_), outage_);
    }
    PgConnection& operator*() { return connection_; }

   private:
    Pool* pool_;
    PgConnection connection_;
    int outage_;
  };
  Result<Lease> acquire(const PgLimits& limits);

  // Closes all connections that exist now: idle ones at once, and others when their work ends. Call
  // it after an outage. A connection to a server that has vanished looks intact until a statement
  // has waited for its time limit, and one to a former primary may show an old state.
  void drop_connections();

  // Runs `work(connection)`, which must only read, and repeats it on a new connection if the
  // connection broke.
  template <class Work>
  auto read(Work&& work) -> std::invoke_result_t<Work, PgConnection&> {
    return read_within(limits_, std::forward<Work>(work));
  }
  // Like `read`, but with these limits of time.
  template <class Work>
  auto read_within(const PgLimits& limits, Work&& work)
      -> std::invoke_result_t<Work, PgConnection&> {
    for (bool again = true;; again = false) {
      auto lease = STRATA_TRY(acquire(limits));
      auto result = work(*lease);
      if (result || !again || (*lease).alive() || result.error().code != ErrorCode::unavailable)
        return result;
    }
  }

  // Runs `work(connection)` in one transaction, and commits if it succeeds. Repeats the whole
  // transaction after a deadlock. The transaction names the actor of this thread (ActingAs).
  template <class Work>
  auto write(Work&& work) -> std::invoke_result_t<Work, PgConnection&> {
    return write_within(limits_, std::forward<Work>(work));
  }
  // Like `write`, but with these limits of time.
  template <class Work>
  auto write_within(const PgLimits& limits, Work&& work)
      -> std::invoke_result_t<Work, PgConnection&> {
    using Outcome = std::invoke_result_t<Work, PgConnection&>;
    auto lease = STRATA_TRY(acquire(limits));
    for (int tries_left = 3;; --tries_left) {
      auto transaction = STRATA_TRY(begin_as_actor(*lease));
      Outcome result = work(*lease);
      if (!result) {
        if ((*lease).take_deadlock() && tries_left > 0) continue;
        return result;
      }
      STRATA_TRY(transaction.commit());
      return result;
    }
  }

 private:
  Result<PgConnection> take(const PgLimits& limits);
  void release(PgConnection connection, int outage);
  void free_slot();

  const std::string dsn_;
  const PgLimits limits_;
  const std::chrono::milliseconds slot_for_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int free_slots_;
  std::vector<PgConnection> idle_;
  int outages_ = 0;  // the number of calls of `drop_connections`
};

}  // namespace strata::store
