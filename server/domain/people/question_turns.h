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

// Whose turn it is to compute. A few questions run at once; the others wait, and those who run make
// way after a while. Fair between persons by the time that their questions ran, however many each
// of them asks (start-time fair queueing, as render/thread/frame_queue): who was served the least
// is next, and who did not ask for a while has no more credit than who waits. Thread-safe.
class QuestionTurns {
 public:
  using Clock = std::chrono::steady_clock;

  // `slice`: so long one runs before another person's question, at least.
  explicit QuestionTurns(int at_once = 1, Clock::duration slice = std::chrono::milliseconds(30))
      : at_once_(at_once), slice_(slice) {}

  // One question's place in it.
  struct Place {
    enum class State { away, waiting, running } state = State::away;
    std::string asker;
    std::uint64_t order = 0;
    Clock::time_point since{};  // running
    std::atomic<bool> paused{false};
    std::condition_variable changed;
    bool over = false;  // it does not wait any more
  };

  void enter(Place& place);  // returns when it is its turn, or when it is over
  void leave(Place& place);
  // Of any thread that works on a question that has entered: hands the turn on where another's is,
  // and returns when it is its own again.
  void check(Place& place);
  void give_up(Place& place);  // who waits does so no more

  void took(std::uint64_t steps) { steps_ += steps; }
  std::uint64_t steps() const { return steps_; }
  int waiting() const;
  int running() const;

 private:
  struct Asker {
    Clock::duration served{};
    int places = 0;  // that have entered
  };
  void charge(Place& place, Clock::time_point now);
  Place* next();
  void fill();
  void stop_running(Place& place);
  void wait(std::unique_lock<std::mutex>& lock, Place& place);

  const int at_once_;
  const Clock::duration slice_;
  mutable std::mutex mutex_;
  std::map<std::string, Asker> askers_;  // of those who have entered
  std::list<Place*> waiting_;
  std::list<Place*> running_;
  Clock::duration now_{};  // what the asker whose turn was last had been served
  std::uint64_t last_order_ = 0;
  std::atomic<std::uint64_t> steps_{0};
};

}  // namespace strata
