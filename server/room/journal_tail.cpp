#include "room/journal_tail.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <map>
#include <utility>

#include "core/log.h"
#include "room/open/following.h"
#include "room/open/open_room.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"

namespace strata::room {
namespace {

constexpr int kThreads = 2;  // of each kind

}  // namespace

JournalTail::JournalTail(store::Store& store, Handlers handlers)
    : handlers_(std::move(handlers)),
      states_(store.journal().states()),
      quick_(kThreads),
      slow_(kThreads) {
  thread_ = std::thread([this] { run(); });
}

JournalTail::~JournalTail() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  thread_.join();
  for (const auto& room : handlers_.rooms()) room->following()->stop();
  for (auto* threads : {&quick_, &slow_}) threads->stop();
  for (auto* threads : {&quick_, &slow_}) threads->join();
}

std::chrono::duration<double> JournalTail::lag() const {
  using Clock = OpenRoom::FollowingPart::Clock;
  const auto now = Clock::now();
  auto oldest = now;
  for (const auto& room : handlers_.rooms())
    oldest = std::min(oldest, room->following()->current_at());
  return now - oldest;
}

void JournalTail::run() {
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kEvery, [this] { return stopping_; })) {
    lock.unlock();
    ask();
    lock.lock();
  }
}

// Holds no room while it waits, so that rooms without participants can be closed.
void JournalTail::ask() {
  std::map<ModelId, std::weak_ptr<OpenRoom>> rooms;
  for (const auto& room : handlers_.rooms()) rooms.emplace(room->id(), room);
  if (rooms.empty()) return;
  std::vector<ModelId> models;
  for (const auto& [id, room] : rooms) models.push_back(id);
  if (reconnects_.exchange(false)) states_->disconnect();
  const auto asked = OpenRoom::FollowingPart::Clock::now();
  const auto states = states_->read(models);
  if (!states) {
    if (!std::exchange(fails_, true))
      log::warning("the models of other nodes cannot be followed: " + states.error().detail);
    return;
  }
  if (std::exchange(fails_, false)) log::info("the models of other nodes can be followed again");
  for (const auto& [id, weak] : rooms) {
    const auto room = weak.lock();
    if (!room) continue;
    const auto state = states->find(id);
    OpenRoom::FollowingPart& following = *room->following();
    if (state == states->end()) {
      handlers_.on_deleted(room);
    } else if (following.end() != OpenRoom::FollowingPart::End::none) {
      handlers_.on_ended(room);
    } else if (following.begin(state->second, asked)) {
      boost::asio::post(following.is_slow() ? slow_ : quick_,
                        [weak = weak, now = state->second, asked] {
                          if (const auto open = weak.lock())
                            open->following()->catch_up(now, asked);
                        });
    }
  }
}

}  // namespace strata::room
