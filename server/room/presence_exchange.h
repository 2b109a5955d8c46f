#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"
#include "room/presence_message.h"

namespace strata::store {
class PresenceChannel;
class Store;
}  // namespace strata::store

namespace strata::room {

class OpenRoom;

// Sends the people in the rooms of this node to the other nodes that show the same models, and
// receives the people at these nodes. A node sends a list of the people at a model if it follows
// the model (Rooms::follow), or if it has received such a list from another node. So if no other
// node shows the model, its owner sends nothing. A list replaces the previous list of the node, and
// is repeated while nothing changes. So a list may be lost.
class PresenceExchange {
 public:
  using Clock = std::chrono::steady_clock;
  // The time between two lists of a model, for each part of the first list.
  static constexpr std::chrono::milliseconds kEvery{250};
  static constexpr std::chrono::milliseconds kRepeatAfter{1000};  // while nothing changes

  using OpenRooms = std::function<std::vector<std::shared_ptr<OpenRoom>>()>;
  // `rooms` is called on the thread of the exchange.
  PresenceExchange(store::Store& store, const Uuid& node, OpenRooms rooms);
  ~PresenceExchange();

  // Call it after an outage of the database, because the present connection may wait in vain.
  void reconnect() { reconnects_ = true; }

 private:
  void run();
  Result<void> exchange();
  void receive(const std::string& text);
  // Adds a part to the list that is being received. Returns the people if the list is complete.
  std::optional<std::vector<Presence>> joined(PresenceMessage part);
  void refuse(const std::string& why);
  using LastLogged = std::optional<Clock::time_point>;
  static void warn_rarely(LastLogged& last, const std::string& line);
  // Returns the texts to send now, and records them in `sent_`.
  std::vector<std::string> due(Clock::time_point now);
  bool pause(std::chrono::milliseconds time);  // returns false if the exchange stops

  const Uuid node_;
  const OpenRooms rooms_;
  // The other members are used by the thread, unless they are atomic.
  const std::unique_ptr<store::PresenceChannel> channel_;
  struct Sent {
    std::vector<std::string> texts;
    Clock::time_point time;
  };
  std::map<ModelId, Sent> sent_;          // the last lists
  std::optional<PresenceMessage> begun_;  // the list that is being received
  bool fails_ = false;
  LastLogged refused_, unsent_;
  std::atomic<bool> reconnects_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;  // used while holding `mutex_`
  std::thread thread_;
};

}  // namespace strata::room
