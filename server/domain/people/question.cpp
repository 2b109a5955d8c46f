#include "domain/people/question.h"

#include <utility>

namespace strata {
namespace {

thread_local Question* current_question = nullptr;

std::string in_millions(std::uint64_t number) {
  return std::to_string((number + 999'999) / 1'000'000);
}

}  // namespace

QuestionLimits limits_of(Role role) {
  using std::chrono::seconds;
  constexpr std::uint64_t kThousandMillion = 1'000'000'000, kGiB = std::uint64_t{1} << 30;
  switch (role) {
    case Role::guest:
    case Role::viewer: return {seconds(60), 20 * kThousandMillion, kGiB};
    case Role::annotator: return {seconds(120), 50 * kThousandMillion, 2 * kGiB};
    default: return {seconds(300), 200 * kThousandMillion, 4 * kGiB};
  }
}

Question::Question(std::string asker, QuestionLimits limits, std::shared_ptr<QuestionTurns> turns)
    : asker_(std::move(asker)),
      limits_(limits),
      turns_(std::move(turns)),
      has_deadline_(limits.time.count() > 0) {
  place_.asker = asker_;
}

void Question::end(Error why) {
  {
    const std::lock_guard lock(mutex_);
    if (ended_) return;
    why_ = std::move(why);
    ended_ = true;
  }
  if (turns_) turns_->give_up(place_);
}

std::optional<Error> Question::why() const {
  const std::lock_guard lock(mutex_);
  return ended_ ? std::optional(why_) : std::nullopt;
}

void Question::throw_ended() {
  const std::lock_guard lock(mutex_);
  throw QuestionEnded(why_);
}

void Question::check() {
  if (has_deadline_ && Clock::now() - begin_ > limits_.time)
    end({ErrorCode::timed_out,
         "Request takes too long",
         "The server stops a request after " + std::to_string(limits_.time.count() / 1000) +
             " seconds, including the time in which it serves other users. Choose a "
             "smaller area, a coarser layer or a shorter condition, or try again later.",
         {}});
  if (turns_) turns_->check(place_);
  if (ended_) throw_ended();
}

void Question::spend(std::uint64_t steps) {
  const std::uint64_t all = steps_ += steps;
  if (limits_.steps == 0 || all <= limits_.steps) return;
  end({ErrorCode::invalid,
       "Request needs too many steps",
       "The answer takes " + in_millions(all) +
           " million steps (one step is one part of the condition at one texel). The limit is " +
           in_millions(limits_.steps) +
           " million. Choose a smaller area (`within`), a coarser layer or a shorter condition.",
       {}});
  throw_ended();
}

void Question::hold(std::int64_t bytes) {
  const std::int64_t held = bytes_ += bytes;
  if (bytes <= 0 || limits_.bytes == 0 || held <= static_cast<std::int64_t>(limits_.bytes)) return;
  bytes_ -= bytes;
  end({ErrorCode::invalid,
       "Request needs too much memory",
       "The answer needs " + in_millions(static_cast<std::uint64_t>(held)) +
           " MB of main memory. The limit is " + in_millions(limits_.bytes) +
           " MB. Choose a coarser layer, or request less at once.",
       {}});
  throw_ended();
}

Question* Question::current() { return current_question; }

Question::Scope::Scope(std::shared_ptr<Question> question)
    : question_(std::move(question)), before_(std::exchange(current_question, question_.get())) {}

Question::Scope::~Scope() { current_question = before_; }

Question::Helper::Helper(Question* question) { current_question = question; }

Question::Helper::~Helper() { current_question = nullptr; }

QuestionTurn::QuestionTurn()
    : question_(Question::current()),
      has_turn_(question_ && question_->turns_ && question_->takes_turns_) {
  if (has_turn_ && question_->turns_held_++ == 0) question_->turns_->enter(question_->place_);
}

QuestionTurn::~QuestionTurn() {
  if (has_turn_ && --question_->turns_held_ == 0) question_->turns_->leave(question_->place_);
}

QuestionMemory::QuestionMemory(std::uint64_t bytes)
    : question_(Question::current()), bytes_(static_cast<std::int64_t>(bytes)) {
  if (question_) question_->hold(bytes_);
}

QuestionMemory::~QuestionMemory() {
  if (question_) question_->hold(-bytes_);
}

}  // namespace strata
