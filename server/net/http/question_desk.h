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

// Where questions wait and are answered: those that read many texels or draw pictures
// (Route::is_question). One person's questions do not hold up another's: few of a person are
// answered at once, and whose next one begins is who has the fewest under way, then who waited
// longest. While they compute they share the processors by time (domain/people/question_turns.h).
// Thread-safe.
class QuestionDesk {
 public:
  struct Options {
    int threads = 8;
    int of_one_at_once = 2;
    std::size_t of_one_waiting = 32;  // more are refused (429)
    std::size_t waiting = 256;        // of all; more are refused (503)
  };
  explicit QuestionDesk(Options options);
  ~QuestionDesk() { stop(); }

  // Of whoever asks, within the limits of their role there. It is ended with the others by
  // `end_all`.
  std::shared_ptr<Question> begin(const Request& request);
  // Calls `work` on a thread of the desk, as the question's own (Question::current). An Error: it
  // will not be called.
  Result<void> post(const std::shared_ptr<Question>& question, std::function<void()> work);

  // All that are asked now and later.
  void end_all(const Error& why);
  void stop();  // ends them, and joins

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
  People people_;  // who has something waiting or under way
  std::size_t waiting_ = 0, under_way_ = 0;
  std::uint64_t begun_ = 0;
  std::vector<std::weak_ptr<Question>> questions_;
  std::optional<Error> over_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace strata::net
