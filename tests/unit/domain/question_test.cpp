// Queries: the reasons for which they end, their limits, and the order in which they run.
#include "domain/people/question.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "mesh/parallel.h"

namespace strata {
namespace {

const Error kGone{ErrorCode::cancelled, "Client gone", "", {}};

std::shared_ptr<Question> question_of(const std::string& who, QuestionLimits limits = {},
                                      std::shared_ptr<QuestionTurns> turns = nullptr) {
  return std::make_shared<Question>(who, limits, std::move(turns));
}

std::optional<ErrorCode> end_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const QuestionEnded& ended) {
    return ended.problem().code;
  }
  return std::nullopt;
}

void wait_until(const std::function<bool()>& holds) {
  while (!holds()) std::this_thread::yield();
}

TEST(Question, goes_on_until_it_is_ended_and_the_first_reason_counts) {
  const auto question = question_of("ann");
  EXPECT_EQ(end_of([&] { question->check(); }), std::nullopt);
  question->end(kGone);
  question->end({ErrorCode::unavailable, "Server stops", "", {}});
  EXPECT_EQ(end_of([&] { question->check(); }), ErrorCode::cancelled);
  EXPECT_EQ(question->why()->title, "Client gone");
}

TEST(Question, is_refused_before_it_takes_more_steps_or_memory_than_it_may) {
  const auto question = question_of("ann", {.steps = 1000, .bytes = 1000});
  const Question::Scope scope(question);
  question->spend(600);
  { const QuestionMemory memory(900); }
  { const QuestionMemory memory(900); }  // freed memory no longer counts
  EXPECT_EQ(end_of([&] { question->spend(600); }), ErrorCode::invalid);
  EXPECT_TRUE(question->ended());
  const auto other = question_of("ann", {.bytes = 1000});
  const Question::Scope inner(other);
  const QuestionMemory first(900);
  EXPECT_EQ(end_of([&] { const QuestionMemory second(200); }), ErrorCode::invalid);
}

TEST(Question, takes_no_longer_than_it_may_unless_its_answer_is_on_its_way) {
  const auto question = question_of("ann", {.time = std::chrono::milliseconds(1)});
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  question->let_take_time();
  EXPECT_EQ(end_of([&] { question->check(); }), std::nullopt);
  const auto other = question_of("ann", {.time = std::chrono::milliseconds(1)});
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_EQ(end_of([&] { other->check(); }), ErrorCode::timed_out);
}

TEST(Question, belongs_to_a_thread_while_its_scope_lasts) {
  EXPECT_EQ(Question::current(), nullptr);
  const auto question = question_of("ann");
  {
    const Question::Scope scope(question);
    EXPECT_EQ(Question::current(), question.get());
    {
      const Question::Aside aside;
      EXPECT_EQ(Question::current(), nullptr);
    }
    EXPECT_EQ(Question::current(), question.get());
  }
  EXPECT_EQ(Question::current(), nullptr);
}

TEST(Question, ends_the_work_of_all_threads_that_work_on_it) {
  for (const int threads : {1, 3}) {
    const auto question = question_of("ann");
    const Question::Scope scope(question);
    std::atomic<int> done = 0;
    EXPECT_EQ(end_of([&] {
                mesh::parallel_for(threads, 100'000, [&](int) {
                  EXPECT_EQ(Question::current(), question.get());
                  if (++done == 10) question->end(kGone);
                });
              }),
              ErrorCode::cancelled);
    EXPECT_GE(done, 10);
    EXPECT_LE(done, 10 + threads) << "each thread ends what it has begun, and begins nothing";
  }
}

TEST(ParallelFor, throws_here_what_is_thrown_on_another_thread) {
  EXPECT_THROW(mesh::parallel_for(4, 100,
                                  [](int i) {
                                    if (i == 57) throw std::runtime_error("broken");
                                  }),
               std::runtime_error);
}

// Queries that compute one at a time, and the order in which they begin.
class Turns : public testing::Test {
 protected:
  // Starts a query on a separate thread. The query runs `work` when its turn comes.
  void begin(const std::string& who, std::function<void(Question&)> work) {
    threads_.emplace_back([this, who, work = std::move(work)] {
      const auto question = question_of(who, {}, turns_);
      const Question::Scope scope(question);
      const QuestionTurn turn;
      {
        const std::lock_guard lock(mutex_);
        order_.push_back(who);
      }
      work(*question);
    });
  }
  void join() {
    for (auto& thread : threads_) thread.join();
    threads_.clear();
  }

  const std::shared_ptr<QuestionTurns> turns_ =
      std::make_shared<QuestionTurns>(1, std::chrono::nanoseconds(0));
  std::mutex mutex_;
  std::vector<std::string> order_;
  std::vector<std::thread> threads_;
};

TEST_F(Turns, one_who_asks_much_makes_way_for_one_who_asks_little) {
  const auto long_one = question_of("ann", {}, turns_);
  const Question::Scope scope(long_one);
  {
    const QuestionTurn turn;
    for (int i = 0; i < 5; ++i) begin("ann", [](Question&) {});
    begin("bob", [](Question&) {});
    wait_until([&] { return turns_->waiting() == 6; });
    // Bob's only query does not wait behind Ann's waiting queries. It runs before the rest of her
    // running query.
    turn.check();
    const std::lock_guard lock(mutex_);
    ASSERT_FALSE(order_.empty());
    EXPECT_EQ(order_.front(), "bob");
  }
  join();
  EXPECT_EQ(order_.size(), 6u);
}

TEST_F(Turns, one_s_own_questions_do_not_interrupt_each_other) {
  const auto question = question_of("ann", {}, turns_);
  const Question::Scope scope(question);
  {
    const QuestionTurn turn;
    begin("ann", [](Question&) {});
    wait_until([&] { return turns_->waiting() == 1; });
    turn.check();
    EXPECT_TRUE(order_.empty());
  }
  join();
}

TEST_F(Turns, who_waits_is_let_go_when_the_question_is_over) {
  const auto running = question_of("ann", {}, turns_), waits = question_of("bob", {}, turns_);
  const Question::Scope scope(running);
  const QuestionTurn turn;
  std::optional<ErrorCode> end;
  std::thread thread([&] {
    const Question::Scope own(waits);
    end = end_of([&] {
      const QuestionTurn its;
      its.check();
    });
  });
  wait_until([&] { return turns_->waiting() == 1; });
  waits->end(kGone);
  thread.join();
  EXPECT_EQ(end, ErrorCode::cancelled);
  EXPECT_EQ(turns_->running(), 1);
  EXPECT_EQ(turns_->waiting(), 0);
}

TEST_F(Turns, what_others_wait_for_takes_no_turn) {
  const auto running = question_of("ann", {}, turns_), edit = question_of("bob", {}, turns_);
  edit->skip_turns();
  const Question::Scope scope(running);
  const QuestionTurn turn;
  const Question::Scope own(edit);
  const QuestionTurn its;
  its.check();
  EXPECT_EQ(turns_->waiting(), 0);
}

}  // namespace
}  // namespace strata
