#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/error.h"
#include "domain/people/question_turns.h"
#include "domain/people/role.h"

namespace strata {

// What one question may cost.
struct QuestionLimits {
  std::chrono::milliseconds time{0};  // from its beginning to its answer; 0: any
  std::uint64_t steps = 0;            // texels times the steps of a formula at each of them; 0: any
  // of main memory that its answer takes while it is made; 0: any
  std::uint64_t bytes = 0;
};

QuestionLimits limits_of(Role role);

// Work that stops because its question is over: thrown by what computes, caught where the question
// was begun.
class QuestionEnded : public std::exception {
 public:
  explicit QuestionEnded(Error problem) : problem_(std::move(problem)) {}
  const Error& problem() const { return problem_; }
  const char* what() const noexcept override { return problem_.title.c_str(); }

 private:
  const Error problem_;
};

// A question that somebody asks, for as long as it is worked on: whose it is, what it may still
// cost, and whether its answer is still wanted. Long loops over texels ask it at every tile
// (`QuestionTurn`, `mesh::parallel_for`): they stop when it is over, and wait where the processors
// are another person's turn. Thread-safe, but for Scope and QuestionTurn, which belong to a thread.
class Question : public std::enable_shared_from_this<Question> {
 public:
  using Clock = std::chrono::steady_clock;

  // Persons share `turns` fairly; null: there is nobody to share with.
  Question(std::string asker, QuestionLimits limits, std::shared_ptr<QuestionTurns> turns);

  const std::string& asker() const { return asker_; }
  // Its answer is not wanted any more, or cannot be given. The first reason counts.
  void end(Error why);
  bool ended() const { return ended_; }
  std::optional<Error> why() const;  // it ended; nothing: it did not
  // From now on it may take any time: its answer is on its way to a client who reads it as quickly
  // as they can.
  void let_take_time() { has_deadline_ = false; }

  // From now on it waits for no turn: what others do waits for it.
  void skip_turns() { takes_turns_ = false; }

  // Throws QuestionEnded where it is over; waits where it is another's turn.
  void check();
  // So many steps are about to be taken: refused as a whole (QuestionEnded, `invalid`) where that
  // is more than it may.
  void spend(std::uint64_t steps);
  // Steps that were taken, for those who count what the server does.
  void took(std::uint64_t steps) {
    if (turns_) turns_->took(steps);
  }
  // Refused (QuestionEnded, `invalid`) where what it holds is more than it may. Given back with
  // `bytes` below 0.
  void hold(std::int64_t bytes);

  // The question that this thread works on; null: none, and nothing limits the work.
  static Question* current();
  class Scope {
   public:
    explicit Scope(std::shared_ptr<Question> question);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    const std::shared_ptr<Question> question_;
    Question* const before_;
  };
  // A thread that helps for a while with what another one works on, which waits for it.
  class Helper {
   public:
    explicit Helper(Question* question);
    ~Helper();
    Helper(const Helper&) = delete;
    Helper& operator=(const Helper&) = delete;
  };
  // Work that others wait for, too, is nobody's question.
  class Aside : public Scope {
   public:
    Aside() : Scope(nullptr) {}
  };

 private:
  friend class QuestionTurn;
  [[noreturn]] void throw_ended();

  const std::string asker_;
  const QuestionLimits limits_;
  const std::shared_ptr<QuestionTurns> turns_;
  const Clock::time_point begin_ = Clock::now();
  std::atomic<bool> ended_{false}, has_deadline_, takes_turns_{true};
  std::atomic<std::uint64_t> steps_{0};
  std::atomic<std::int64_t> bytes_{0};
  mutable std::mutex mutex_;
  Error why_;
  std::atomic<int> turns_held_{0};  // by the thread that works on it, and its helpers meanwhile
  QuestionTurns::Place place_;
};

// The processors, for one stretch of the current question's work. Does nothing where there is none.
class QuestionTurn {
 public:
  QuestionTurn();
  ~QuestionTurn();
  QuestionTurn(const QuestionTurn&) = delete;
  QuestionTurn& operator=(const QuestionTurn&) = delete;
  void check() const {
    if (question_) question_->check();
  }
  // `steps` of its work at once: tiles, texels.
  void check(std::uint64_t steps) const {
    if (!question_) return;
    question_->took(steps);
    question_->check();
  }

 private:
  Question* const question_;
  const bool has_turn_;
};

// Whether the current question goes on (Question::check), for what is no work of its own: rows that
// a client waits for.
inline void check_question() {
  if (Question* question = Question::current()) question->check();
}

// Memory that the current question holds, while this lives.
class QuestionMemory {
 public:
  explicit QuestionMemory(std::uint64_t bytes);
  ~QuestionMemory();
  QuestionMemory(const QuestionMemory&) = delete;
  QuestionMemory& operator=(const QuestionMemory&) = delete;

 private:
  Question* const question_;
  const std::int64_t bytes_;
};

}  // namespace strata
