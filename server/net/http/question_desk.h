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

// Queues and runs the requests that read many texels or render images (questions, see
// Route::is_question). The questions of one user do not delay the questions of others. Each user
// can run only a few questions at a time. The next question is from the user with the fewest
// running questions. Among users with the same number, the one who has waited longest is next.
// Running questions share the processors (domain/people/question_turns.h). Thread-safe.
class QuestionDesk {
 public:
  struct Options {
    int threads = 8;
    int of_one_at_once = 2;
    std::size_t of_one_waiting = 32;  // more questions are refused (429)
    std::size_t waiting = 256;        // of all users; more questions are refused (503)
  };
  explicit QuestionDesk(Options options);
  ~QuestionDesk() { stop(); }

  // Returns a question of the caller, with the limits of the caller's role. `end_all` also ends
  // this question.
  std::shared_ptr<Question> begin(const Request& request);
  // Calls `work` on a thread of the desk, with the question as Question::current. Does not call
  // `work` if it returns an error.
  Result<void> post(const std::shared_ptr<Question>& question, std::function<void()> work);

  // Ends all current and later questions.
  void end_all(const Error& why);
  void stop();  // ends all questions and joins the threads

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
