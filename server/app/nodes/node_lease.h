#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/error.h"
#include "core/uuid.h"
#include "store/nodes/nodes.h"

namespace strata::room {
class Rooms;
}

namespace strata::app {

// Keeps the lease of this process while the site has several nodes (store/nodes/nodes.h). If no
// renewal that was sent within the last `trusted_for` has succeeded, other nodes may soon claim the
// models. This process then suspends its rooms (Rooms::suspend), and joins the site again when the
// database answers. `trusted_for` is shorter than the lease, so the rooms stop acknowledging edits
// before another node can claim their models.
//
// One thread renews the lease, and may wait for the database. Another thread watches the monotonic
// clock, and never waits for the database. Thread-safe.
class NodeLease {
 public:
  struct Options {
    store::NewNode node;
    std::chrono::milliseconds every{1000};
    std::chrono::milliseconds trusted_for{2000};
  };
  // Joins. Returns an error if the database is unreachable. `nodes` and `rooms` must outlive the
  // lease.
  static Result<std::unique_ptr<NodeLease>> start(store::Nodes& nodes, room::Rooms& rooms,
                                                  Options options);
  ~NodeLease();  // stops renewing; call `leave` first

  // Returns whether this process may acknowledge edits: a renewal that was sent within the last
  // `trusted_for` has succeeded.
  bool holds() const;
  // Returns the time until the lease ends, by the clock of this process. At least 0.
  std::chrono::milliseconds left() const;
  bool draining() const { return draining_; }
  const store::NewNode& node() const { return options_.node; }

  // Allows other nodes to claim the models of this node. This node renews its lease until `leave`.
  void begin_drain();
  // Stops renewing and removes the node. Blocks for a few seconds at most.
  void leave();

 private:
  using Clock = std::chrono::steady_clock;

  NodeLease(store::Nodes& nodes, room::Rooms& rooms, Options options);
  void renew_until_stopped();
  void renew(Clock::time_point sent);
  void join_again();
  void watch_until_stopped();
  bool is_held(Clock::time_point now) const;  // call while holding `mutex_`
  store::NodeLoad load();
  void stop();

  store::Nodes& nodes_;
  room::Rooms& rooms_;
  const Options options_;
  std::atomic<bool> draining_{false};
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Clock::time_point sent_;  // when the last successful renewal was sent
  bool is_over_ = false;    // ended in the database; the rooms must be suspended before a new lease
  bool suspended_ = false;  // the rooms acknowledge no edits
  bool stopping_ = false;
  // Used by the renewing thread: when the load was last measured, and the processor time until
  // then.
  Clock::time_point measured_;
  double processor_s_ = 0;
  std::thread renewer_, watcher_;
};

}  // namespace strata::app
