#pragma once

#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace strata::store {
class ModelStates;
class Store;
}  // namespace strata::store

namespace strata::room {

class OpenRoom;

// Keeps the rooms up to date that follow other nodes (room/open/following.h). One thread asks for
// the states of all their models in one query. So followers cost the commit of an edit nothing, and
// their number does not change the load of the owner. Rooms with news read them on other threads.
// A room whose last reading was slow uses threads of its own kind, so it does not delay the others.
class JournalTail {
 public:
  static constexpr std::chrono::milliseconds kEvery{200};

  struct Handlers {
    std::function<std::vector<std::shared_ptr<OpenRoom>>()> rooms;     // returns those that follow
    std::function<void(const std::shared_ptr<OpenRoom>&)> on_deleted;  // the model does not exist
    // The room does not follow any longer (OpenRoom::FollowingPart::end).
    std::function<void(const std::shared_ptr<OpenRoom>&)> on_ended;
  };
  // The handlers are called on the thread of the tail.
  JournalTail(store::Store& store, Handlers handlers);
  // Ends the readings that are in progress, and closes no room.
  ~JournalTail();

  // Call it after an outage of the database, because the present connection may wait in vain.
  void reconnect() { reconnects_ = true; }
  // Returns the time since every room showed everything that was in the database. 0: no rooms.
  std::chrono::duration<double> lag() const;

 private:
  void run();
  void ask();

  const Handlers handlers_;
  const std::unique_ptr<store::ModelStates> states_;  // used by the thread
  bool fails_ = false;                                // used by the thread
  std::atomic<bool> reconnects_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  boost::asio::thread_pool quick_, slow_;
  std::thread thread_;
};

}  // namespace strata::room
