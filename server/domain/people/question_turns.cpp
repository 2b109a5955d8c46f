#include "domain/people/question_turns.h"

#include <algorithm>

namespace strata {

void QuestionTurns::enter(Place& place) {
  std::unique_lock lock(mutex_);
  Asker& asker = askers_[place.asker];
  if (asker.places++ == 0) asker.served = std::max(asker.served, now_);
  place.order = ++last_order_;
  place.state = Place::State::waiting;
  waiting_.push_back(&place);
  fill();
  wait(lock, place);
}

void QuestionTurns::leave(Place& place) {
  const std::lock_guard lock(mutex_);
  if (place.state == Place::State::running) stop_running(place);
  waiting_.remove(&place);
  place.state = Place::State::away;
  place.paused = false;
  --askers_.at(place.asker).places;
  // Keeps the entry of a user who has used more time than others, until these have used as much.
  // Otherwise, a new question of this user would begin with less time than the user has used.
  std::erase_if(askers_, [&](const auto& each) {
    return each.second.places == 0 && each.second.served <= now_;
  });
  fill();
}

void QuestionTurns::check(Place& place) {
  if (!place.paused) {
    // The thread that holds the lock writes `since` before it sets `paused` to false.
    const std::lock_guard lock(mutex_);
    if (place.state != Place::State::running) return;
    const auto now = Clock::now();
    if (now - place.since < slice_ || waiting_.empty()) return;
    charge(place, now);
    const Place* other = next();
    if (other == nullptr || other->asker == place.asker) return;
    if (askers_.at(other->asker).served >= askers_.at(place.asker).served) return;
    stop_running(place);
    place.state = Place::State::waiting;
    place.paused = true;
    waiting_.push_back(&place);
    fill();
  }
  std::unique_lock lock(mutex_);
  wait(lock, place);
}

void QuestionTurns::give_up(Place& place) {
  const std::lock_guard lock(mutex_);
  place.over = true;
  place.changed.notify_all();
}

int QuestionTurns::waiting() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(waiting_.size());
}

int QuestionTurns::running() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(running_.size());
}

void QuestionTurns::charge(Place& place, Clock::time_point now) {
  askers_.at(place.asker).served += now - place.since;
  place.since = now;
}

QuestionTurns::Place* QuestionTurns::next() {
  Place* first = nullptr;
  for (Place* place : waiting_) {
    if (first == nullptr) {
      first = place;
      continue;
    }
    const auto its = askers_.at(place->asker).served, best = askers_.at(first->asker).served;
    if (its < best || (its == best && place->order < first->order)) first = place;
  }
  return first;
}

void QuestionTurns::fill() {
  while (static_cast<int>(running_.size()) < at_once_) {
    Place* place = next();
    if (place == nullptr) return;
    waiting_.remove(place);
    running_.push_back(place);
    now_ = std::max(now_, askers_.at(place->asker).served);
    place->state = Place::State::running;
    place->since = Clock::now();
    place->paused = false;
    place->changed.notify_all();
  }
}

void QuestionTurns::stop_running(Place& place) {
  charge(place, Clock::now());
  running_.remove(&place);
}

void QuestionTurns::wait(std::unique_lock<std::mutex>& lock, Place& place) {
  place.changed.wait(lock, [&] { return place.over || place.state != Place::State::waiting; });
}

}  // namespace strata
