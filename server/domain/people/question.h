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

// The limits for one question.
struct QuestionLimits {
  std::chrono::milliseconds time{0};  // from the beginning to the answer; 0: no limit
  std::uint64_t steps = 0;            // texels times formula steps per texel; 0: no limit
  // The main memory while the answer is computed, in bytes. 0: no limit.
  std::uint64_t bytes = 0;
};

QuestionLimits limits_of(Role role);

// Computations throw this exception to stop the work on a question that has ended. The code that
// began the question catches it.
class QuestionEnded : public std::exception {
 public:
  explicit QuestionEnded(Error problem) : problem_(std::move(problem)) {}
  const Error& problem() const { return problem_; }
  const char* what() const noexcept override { return problem_.title.c_str(); }

 private:
  const Error problem_;
};

// A query: a request whose answer the server is computing, with its user, its remaining limits, and
// whether the answer is still needed. Long loops over texels check the question at every tile with
// `QuestionTurn` or `mesh::parallel_for`. They stop when it has ended, and wait while questions of
// other users are using the processors. Thread-safe, except Scope and QuestionTurn (one thread).
class Question : public std::enable_shared_from_this<Question> {
 public:
  using Clock = std::chrono::steady_clock;

  // `turns` shares the processors fairly between users. If it is null, the question never waits.
  Question(std::string asker, QuestionLimits limits, std::shared_ptr<QuestionTurns> turns);

  const std::string& asker() const { return asker_; }
  // Ends the question because its answer is no longer needed or cannot be computed. Keeps only the
  // first reason.
  void end(Error why);
  bool ended() const { return ended_; }
  // Whether the question has ended or its time has passed. Unlike check(), neither throws nor
  // waits.
  bool is_over() const { return ended_ || (has_deadline_ && Clock::now() - begin_ > limits_.time); }
  std::optional<Error> why() const;  // nullopt if the question has not ended
  // Removes the time limit. Call when the answer is being sent, because the speed of sending
  // depends on the client.
  void let_take_time() { has_deadline_ = false; }

  // Stops waiting for turns. Call when other users wait for the end of this question.
  void skip_turns() { takes_turns_ = false; }

  // Throws QuestionEnded if the question has ended. Waits during a turn of another user.
  void check();
  // Call before the computation takes this number of steps. Throws QuestionEnded (`invalid`) if the
  // total number of steps exceeds the limit. Then the computation must not begin these steps.
  void spend(std::uint64_t steps);
  // Counts steps after they were taken, for the metrics of the server.
  void took(std::uint64_t steps) {
    if (turns_) turns_->took(steps);
  }
  // Counts `bytes` as used, or as released if negative. If the total exceeds the limit, throws
  // QuestionEnded (`invalid`).
  void hold(std::int64_t bytes);

  // Returns the question that this thread works on, or null if its work belongs to no question.
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
  // Marks a thread that works on the question of another thread, while the other thread waits.
  class Helper {
   public:
    explicit Helper(Question* question);
    ~Helper();
    Helper(const Helper&) = delete;
    Helper& operator=(const Helper&) = delete;
  };
  // Marks a thread whose work belongs to no question, because other users also need the result.
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
  std::atomic<int> turns_held_{0};  // by the thread of the question and its helpers
  QuestionTurns::Place place_;
};

// A turn for one part of the work on the current question. Has no effect without a question.
class QuestionTurn {
 public:
  QuestionTurn();
  ~QuestionTurn();
  QuestionTurn(const QuestionTurn&) = delete;
  QuestionTurn& operator=(const QuestionTurn&) = delete;
  void check() const {
    if (question_) question_->check();
  }
  // `steps` is the amount of work since the last check: tiles or texels.
  void check(std::uint64_t steps) const {
    if (!question_) return;
    question_->took(steps);
    question_->check();
  }

 private:
  Question* const question_;
  const bool has_turn_;
};

// Checks the current question (Question::check) during work that needs no turn, such as sending
// rows to a client.
inline void check_question() {
  if (Question* question = Question::current()) question->check();
}

// Counts memory for the current question during the lifetime of this object.
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
