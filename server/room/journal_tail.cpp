#include "room/journal_tail.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "core/log.h"
#include "room/open/following.h"
#include "room/open/open_room.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"

namespace strata::room {
namespace {

constexpr int kTailThreads = 2;

}  // namespace

JournalTail::JournalTail(store::Store& store, Handlers handlers)
    : store_(store), handlers_(std::move(handlers)), readers_(kTailThreads) {
  thread_ = std::thread([this] { run(); });
}

JournalTail::~JournalTail() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  thread_.join();
  readers_.join();
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

void JournalTail::ask() {
  const auto rooms = handlers_.rooms();
  if (rooms.empty()) return;
  std::vector<ModelId> models;
  for (const auto& room : rooms) models.push_back(room->id());
  const auto asked = OpenRoom::FollowingPart::Clock::now();
  const auto states = store_.journal().model_states(models);
  if (!states) {
    if (!std::exchange(fails_, true))
      log::warning("the models of other nodes cannot be followed: " + states.error().detail);
    return;
  }
  if (std::exchange(fails_, false)) log::info("the models of other nodes can be followed again");
  for (const auto& room : rooms) {
    const auto state = states->find(room->id());
    if (state == states->end()) {
      handlers_.on_deleted(room);
    } else if (room->following()->end() != OpenRoom::FollowingPart::End::none) {
      handlers_.on_ended(room);
    } else if (room->following()->begin()) {
      boost::asio::post(readers_, [room, now = state->second, asked] {
        room->following()->catch_up(now, asked);
      });
    }
  }
}

}  // namespace strata::room
