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

// The limits of one question.
struct QuestionLimits {
  std::chrono::milliseconds time{0};  // from begin to answer; 0: no limit
  std::uint64_t steps = 0;            // texels times formula steps per texel; 0: no limit
  // of main memory while the answer is made; 0: no limit
  std::uint64_t bytes = 0;
};

QuestionLimits limits_of(Role role);

// Stops the work of a question that has ended: thrown by computations, caught where the question
// was begun.
class QuestionEnded : public std::exception {
 public:
  explicit QuestionEnded(Error problem) : problem_(std::move(problem)) {}
  const Error& problem() const { return problem_; }
  const char* what() const noexcept override { return problem_.title.c_str(); }

 private:
  const Error problem_;
};

// A question while it is being worked on: its user, its remaining limits, and whether its answer is
// still needed. Long loops over texels check it at every tile (`QuestionTurn`,
// `mesh::parallel_for`): they stop when it has ended, and wait while another person's questions
// have the processors. Thread-safe, except Scope and QuestionTurn, which belong to a thread.
class Question : public std::enable_shared_from_this<Question> {
 public:
  using Clock = std::chrono::steady_clock;

  // People share `turns` fairly; null: without sharing.
  Question(std::string asker, QuestionLimits limits, std::shared_ptr<QuestionTurns> turns);

  const std::string& asker() const { return asker_; }
  // Ends it: its answer is no longer needed, or cannot be given. The first reason counts.
  void end(Error why);
  bool ended() const { return ended_; }
  std::optional<Error> why() const;  // nothing: it has not ended
  // Removes the time limit: the answer is being sent, as fast as the client reads it.
  void let_take_time() { has_deadline_ = false; }

  // Stops waiting for turns: others wait for this question.
  void skip_turns() { takes_turns_ = false; }

  // Throws QuestionEnded if it has ended; waits during another person's turn.
  void check();
  // Call before taking this number of steps: refuses all of them (QuestionEnded, `invalid`) if they
  // exceed the limit.
  void spend(std::uint64_t steps);
  // Counts the steps taken, for the server's metrics.
  void took(std::uint64_t steps) {
    if (turns_) turns_->took(steps);
  }
  // Refuses (QuestionEnded, `invalid`) if the held memory exceeds the limit. Negative `bytes`
  // release memory.
  void hold(std::int64_t bytes);

  // The question that this thread works on; null: the work has no limits.
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
  // A thread that helps another one, which waits for it, with a question.
  class Helper {
   public:
    explicit Helper(Question* question);
    ~Helper();
    Helper(const Helper&) = delete;
    Helper& operator=(const Helper&) = delete;
  };
  // For work that others also wait for: it belongs to no question.
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
  std::atomic<int> turns_held_{0};  // by the thread that works on it, and its helpers
  QuestionTurns::Place place_;
};

// A turn for one part of the current question's work. Does nothing without a question.
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

// Checks the current question (Question::check), during work that needs no turn: rows that a client
// waits for.
inline void check_question() {
  if (Question* question = Question::current()) question->check();
}

// Counts memory for the current question as long as this exists.
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
