#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "domain/people/question.h"
#include "net/http/http_types.h"

namespace strata::net {

// Queues and answers the questions that read many texels or render pictures (Route::is_question).
// One user's questions do not delay those of others: a user has a few at a time, and the next one
// is of the user with the fewest running questions, then of the one with the longest wait. While
// they compute they share the processors by time (domain/people/question_turns.h). Thread-safe.
class QuestionDesk {
 public:
  struct Options {
    int threads = 8;
    int of_one_at_once = 2;
    std::size_t of_one_waiting = 32;  // more are refused (429)
    std::size_t waiting = 256;        // of all users; more are refused (503)
  };
  explicit QuestionDesk(Options options);
  ~QuestionDesk() { stop(); }

  // Returns a question of the caller, within the limits of the caller's role. `end_all` ends it
  // with the others.
  std::shared_ptr<Question> begin(const Request& request);
  // Calls `work` on a thread of the desk, with the question as Question::current. Error: `work`
  // will not be called.
  Result<void> post(const std::shared_ptr<Question>& question, std::function<void()> work);

  // Ends all current and later questions.
  void end_all(const Error& why);
  void stop();  // ends all questions and joins

  std::size_t waiting() const;
  std::uint64_t steps() const { return turns_->steps(); }
  std::size_t under_way() const;

 private:
  struct Task {
    std::shared_ptr<Question> question;
    std::function<void()> work;
  };
  struct Person {
    std::deque<Task> waiting;
    int under_way = 0;
    std::uint64_t last_begun = 0;
  };
  using People = std::map<std::string, Person>;

  void run();
  People::iterator next();

  const Options options_;
  const std::shared_ptr<QuestionTurns> turns_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  People people_;  // users with waiting or running questions
  std::size_t waiting_ = 0, under_way_ = 0;
  std::uint64_t begun_ = 0;
  std::vector<std::weak_ptr<Question>> questions_;
  std::optional<Error> over_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace strata::net
