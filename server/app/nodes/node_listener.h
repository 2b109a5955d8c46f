#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "core/error.h"
#include "store/nodes/node_messages.h"

namespace strata::app {

// Receives the messages of the other nodes of the site (store/nodes/node_messages.h), on its own
// thread. A notification of the database wakes it, and it also reads once a second, so a lost
// notification or connection loses no message.
class NodeListener {
 public:
  // Called on the thread of the listener. May block.
  struct Handlers {
    // `age` is the time since the change, by the clock of the database. After an error
    // `unavailable` or `busy`, the message is passed again later, before all others.
    std::function<Result<void>(const store::NodeMessage& message, std::chrono::nanoseconds age)>
        on_message;
    // Called if messages may be missing. Everything must then be read again. After an error
    // `unavailable` or `busy`, it is called again later.
    std::function<Result<void>()> on_missed;
  };
  struct Options {
    // A message that cannot be passed on for this time, while the database answers, is dropped, and
    // messages are reported as missed. Otherwise a damaged page of one table would hold back all
    // later messages, such as those about revoked access.
    std::chrono::milliseconds give_up_after{60'000};
  };
  // Reads the messages from now on. If the database does not answer now, the listener reports
  // missed messages as soon as the database answers.
  NodeListener(std::unique_ptr<store::NodeMessages> messages, Handlers handlers, Options options);
  NodeListener(std::unique_ptr<store::NodeMessages> messages, Handlers handlers)
      : NodeListener(std::move(messages), std::move(handlers), Options()) {}
  ~NodeListener() { stop(); }
  void stop();  // waits for a running handler

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    store::NodeMessage message;
    std::chrono::nanoseconds age;  // when the message was read
    Clock::time_point read;
  };
  void run();
  Result<void> read();
  bool pass_on();  // returns false if messages still wait
  // Returns whether to call a handler again that returned this error.
  bool may_try_again(const Error& error);
  void wait_for_news();
  bool pause(std::chrono::milliseconds time);  // returns false if the listener stops

  const std::unique_ptr<store::NodeMessages> messages_;
  const Handlers handlers_;
  const Options options_;
  // Used only by the thread of the listener.
  std::deque<Waiting> waiting_;
  bool missed_ = false, more_ = false, fails_ = false;
  Clock::time_point pruned_ = Clock::now();
  std::optional<Clock::time_point> blocked_since_;  // since when a handler returns errors

  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace strata::app
