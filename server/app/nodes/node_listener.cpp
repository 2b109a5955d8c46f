#include "app/nodes/node_listener.h"

#include <algorithm>
#include <utility>

#include "core/log.h"

namespace strata::app {
namespace {

using std::chrono::milliseconds;
using store::NodeMessage;

constexpr milliseconds kReadEvery{1000};
constexpr milliseconds kStopWithin{100};
constexpr std::chrono::seconds kPruneEvery{60};

bool is_passing(const Error& error) {
  return error.code == ErrorCode::unavailable || error.code == ErrorCode::busy;
}

}  // namespace

NodeListener::NodeListener(std::unique_ptr<store::NodeMessages> messages, Handlers handlers,
                           Options options)
    : messages_(std::move(messages)), handlers_(std::move(handlers)), options_(options) {
  if (auto begun = read(); !begun) {
    missed_ = fails_ = true;
    log::warning("messages of other nodes cannot be read: " + begun.error().detail);
  }
  thread_ = std::thread([this] { run(); });
}

void NodeListener::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

bool NodeListener::pause(milliseconds time) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, time, [this] { return stopping_; });
}

Result<void> NodeListener::read() {
  auto news = STRATA_TRY(messages_->read());
  more_ = news.more;
  missed_ = missed_ || news.missed;
  const auto now = Clock::now();
  for (NodeMessage& message : news.messages) {
    const auto age = std::chrono::duration_cast<std::chrono::nanoseconds>(news.time - message.time);
    // One check of a user's rights suffices for all changes that are visible now.
    if (message.kind == NodeMessage::Kind::access)
      std::erase_if(waiting_, [&](const Waiting& earlier) {
        return earlier.message.kind == message.kind && earlier.message.user == message.user;
      });
    waiting_.push_back({std::move(message), age, now});
  }
  return {};
}

bool NodeListener::pass_on() {
  if (missed_) {
    const auto read_again = handlers_.on_missed();
    if (!read_again && may_try_again(read_again.error())) return false;
    if (!read_again)
      log::warning("not everything could be read again: " + read_again.error().detail);
    missed_ = false;
    blocked_since_.reset();
  }
  for (; !waiting_.empty(); waiting_.pop_front()) {
    if (!pause(milliseconds(0))) return false;
    const Waiting& next = waiting_.front();
    const auto passed = handlers_.on_message(next.message, next.age + (Clock::now() - next.read));
    if (!passed) {
      if (may_try_again(passed.error())) return false;
      log::warning("a message of another node had no effect: " + passed.error().detail);
      if (is_passing(passed.error())) missed_ = true;
    }
    blocked_since_.reset();
  }
  return true;
}

bool NodeListener::may_try_again(const Error& error) {
  if (!is_passing(error)) return false;
  const auto now = Clock::now();
  if (!blocked_since_) blocked_since_ = now;
  // During an outage, everything waits.
  return now - *blocked_since_ < options_.give_up_after || !messages_->answers();
}

// Waits in steps, so that `stop` need not wait long.
void NodeListener::wait_for_news() {
  for (auto waited = milliseconds(0); waited < kReadEvery && pause(milliseconds(0));
       waited += kStopWithin) {
    const auto woken = messages_->wait(kStopWithin);
    if (!woken) return void(pause(kReadEvery));
    if (*woken) return;
  }
}

// Does not read further messages while a message waits. So the memory is bounded: after a long
// outage, the reader reports missed messages instead.
void NodeListener::run() {
  while (pause(milliseconds(0))) {
    if (!pass_on()) {
      if (!pause(kReadEvery)) return;
      continue;
    }
    if (!more_) wait_for_news();
    const auto done = read();
    if (!done && !fails_)
      log::warning("messages of other nodes cannot be read: " + done.error().detail);
    if (done && fails_) log::info("messages of other nodes can be read again");
    fails_ = !done;
    if (!done) {
      more_ = false;
      if (!pause(kReadEvery)) return;
    } else if (Clock::now() - pruned_ > kPruneEvery) {
      pruned_ = Clock::now();
      if (auto pruned = messages_->prune(); !pruned)
        log::warning("old messages of nodes could not be deleted: " + pruned.error().detail);
    }
  }
}

}  // namespace strata::app
