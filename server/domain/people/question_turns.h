#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <map>
#include <mutex>
#include <string>

namespace strata {

// Shares the processors between questions. A few questions run at the same time. The others wait,
// and running questions pause after a while. The processor time is shared fairly between users,
// regardless of the number of their questions (start-time fair queueing, as in
// render/thread/frame_queue). The user with the least processor time is
// next. Users gain no advantage from time without questions. Thread-safe.
class QuestionTurns {
 public:
  using Clock = std::chrono::steady_clock;

  // A question runs for at least `slice` before it pauses for a question of another user.
  explicit QuestionTurns(int at_once = 1, Clock::duration slice = std::chrono::milliseconds(30))
      : at_once_(at_once), slice_(slice) {}

  // The position of one question in the queue.
  struct Place {
    enum class State { away, waiting, running } state = State::away;
    std::string asker;
    std::uint64_t order = 0;
    Clock::time_point since{};  // beginning of the current running time
    std::atomic<bool> paused{false};
    std::condition_variable changed;
    bool over = false;  // the question no longer waits
  };

  void enter(Place& place);  // returns when the turn begins, or the question stops waiting
  void leave(Place& place);
  // Call from any thread that works on an entered question. If a turn of another question is due,
  // waits for the next turn of this question.
  void check(Place& place);
  void give_up(Place& place);  // stops waiting

  void took(std::uint64_t steps) { steps_ += steps; }
  std::uint64_t steps() const { return steps_; }
  int waiting() const;
  int running() const;

 private:
  struct Asker {
    Clock::duration served{};
    int places = 0;  // entered questions
  };
  void charge(Place& place, Clock::time_point now);
  Place* next();
  void fill();
  void stop_running(Place& place);
  void wait(std::unique_lock<std::mutex>& lock, Place& place);

  const int at_once_;
  const Clock::duration slice_;
  mutable std::mutex mutex_;
  std::map<std::string, Asker> askers_;  // users with entered questions
  std::list<Place*> waiting_;
  std::list<Place*> running_;
  Clock::duration now_{};  // the served time of the user who had the last turn
  std::uint64_t last_order_ = 0;
  std::atomic<std::uint64_t> steps_{0};
};

}  // namespace strata
