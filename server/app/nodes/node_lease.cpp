#include "app/nodes/node_lease.h"

#include <sys/resource.h>

#include <algorithm>
#include <utility>

#include "core/log.h"
#include "room/rooms.h"

namespace strata::app {
namespace {

constexpr int kForgetEvery = 60;  // renewals

// Returns the processor time that this process has used.
double processor_seconds() {
  rusage used{};
  if (getrusage(RUSAGE_SELF, &used) != 0) return 0;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

}  // namespace

Result<std::unique_ptr<NodeLease>> NodeLease::start(store::Nodes& nodes, room::Rooms& rooms,
                                                    Options options) {
  std::unique_ptr<NodeLease> lease(new NodeLease(nodes, rooms, std::move(options)));
  const auto sent = Clock::now();
  STRATA_TRY(nodes.join(lease->options_.node));
  lease->sent_ = lease->measured_ = sent;
  lease->processor_s_ = processor_seconds();
  lease->renewer_ = std::thread([it = lease.get()] { it->renew_until_stopped(); });
  lease->watcher_ = std::thread([it = lease.get()] { it->watch_until_stopped(); });
  return lease;
}

NodeLease::NodeLease(store::Nodes& nodes, room::Rooms& rooms, Options options)
    : nodes_(nodes), rooms_(rooms), options_(std::move(options)) {}

NodeLease::~NodeLease() { stop(); }

void NodeLease::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  if (renewer_.joinable()) renewer_.join();
  if (watcher_.joinable()) watcher_.join();
}

bool NodeLease::is_held(Clock::time_point now) const {
  return !is_over_ && now - sent_ < options_.trusted_for;
}

bool NodeLease::holds() const {
  const std::lock_guard lock(mutex_);
  return !suspended_ && is_held(Clock::now());
}

std::chrono::milliseconds NodeLease::left() const {
  const std::lock_guard lock(mutex_);
  if (is_over_) return {};
  const auto left = sent_ + store::Nodes::kLease - Clock::now();
  return std::max(std::chrono::duration_cast<std::chrono::milliseconds>(left),
                  std::chrono::milliseconds(0));
}

void NodeLease::begin_drain() {
  draining_ = true;
  if (auto begun = nodes_.begin_drain(options_.node.id); !begun)
    log::warning("the other nodes do not know yet that this node is stopping: " +
                 begun.error().detail);
}

void NodeLease::leave() {
  stop();
  if (auto left = nodes_.leave(options_.node.id); !left)
    log::warning("this node could not be removed from the database: " + left.error().detail);
}

store::NodeLoad NodeLease::load() {
  const auto now = Clock::now();
  const double used_s = processor_seconds();
  const double passed_s = std::chrono::duration<double>(now - measured_).count();
  store::NodeLoad load{static_cast<int>(rooms_.open_rooms()),
                       static_cast<int>(rooms_.participants()),
                       passed_s > 0 ? static_cast<float>((used_s - processor_s_) / passed_s) : 0};
  measured_ = now;
  processor_s_ = used_s;
  return load;
}

// Runs on the only thread that waits for the database.
void NodeLease::renew_until_stopped() {
  for (int count = 1;; ++count) {
    const auto sent = Clock::now();
    {
      std::unique_lock lock(mutex_);
      changed_.wait_until(lock, sent + options_.every, [this] { return stopping_; });
      if (stopping_) return;
    }
    renew(Clock::now());
    if (count % kForgetEvery == 0) (void)nodes_.forget_ended();
  }
}

void NodeLease::renew(Clock::time_point sent) {
  bool is_over = false;
  {
    const std::lock_guard lock(mutex_);
    is_over = is_over_;
  }
  if (is_over) return join_again();
  const auto renewed = nodes_.renew(options_.node.id, load());
  {
    const std::lock_guard lock(mutex_);
    if (renewed) sent_ = sent;
    if (!renewed && renewed.error().code == ErrorCode::gone) is_over_ = true;
    changed_.notify_all();
  }
  if (renewed) return;
  log::warning("the lease of this node could not be renewed: " + renewed.error().detail);
  if (renewed.error().code == ErrorCode::gone) join_again();
}

// Other nodes may have claimed the models since the lease ended. So the rooms are suspended first,
// and each is compared with the database when it resumes.
void NodeLease::join_again() {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopping_ || suspended_; });
    if (stopping_ || draining_) return;
  }
  const auto sent = Clock::now();
  if (auto joined = nodes_.join(options_.node); !joined) {
    log::warning("this node could not join the site again: " + joined.error().detail);
    return;
  }
  const std::lock_guard lock(mutex_);
  sent_ = sent;
  is_over_ = false;
  changed_.notify_all();
  log::info("this node has joined the site again");
}

// Suspends and resumes the rooms on one thread, so that both happen in order.
void NodeLease::watch_until_stopped() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    const bool held = is_held(Clock::now());
    if (held == !suspended_) {
      if (held)
        changed_.wait_until(lock, sent_ + options_.trusted_for);
      else
        changed_.wait(lock);
      continue;
    }
    lock.unlock();
    if (held)
      rooms_.resume();
    else
      rooms_.suspend();
    lock.lock();
    suspended_ = !held;
    changed_.notify_all();
  }
}

}  // namespace strata::app
