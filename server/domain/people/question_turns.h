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

// Shares the processors between questions. A few run at once; the others wait, and running ones
// pause after a while. Fair between people by the running time of their questions, regardless of
// their number (start-time fair queueing, as render/thread/frame_queue): the person with the least
// time is next, and a pause in asking earns no credit. Thread-safe.
class QuestionTurns {
 public:
  using Clock = std::chrono::steady_clock;

  // `slice`: least running time before another person's question.
  explicit QuestionTurns(int at_once = 1, Clock::duration slice = std::chrono::milliseconds(30))
      : at_once_(at_once), slice_(slice) {}

  // One question's place in the queue.
  struct Place {
    enum class State { away, waiting, running } state = State::away;
    std::string asker;
    std::uint64_t order = 0;
    Clock::time_point since{};  // begin of the running time
    std::atomic<bool> paused{false};
    std::condition_variable changed;
    bool over = false;  // no longer waits
  };

  void enter(Place& place);  // returns when it is its turn, or when it is over
  void leave(Place& place);
  // Call from any thread that works on an entered question: yields the turn to another if due, and
  // returns in the next own turn.
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
  std::map<std::string, Asker> askers_;  // with entered questions
  std::list<Place*> waiting_;
  std::list<Place*> running_;
  Clock::duration now_{};  // the served time of the asker with the last turn
  std::uint64_t last_order_ = 0;
  std::atomic<std::uint64_t> steps_{0};
};

}  // namespace strata
