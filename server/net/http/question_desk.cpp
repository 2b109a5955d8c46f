#include "net/http/question_desk.h"

#include <algorithm>

namespace strata::net {
namespace {

// The number of processors for each simultaneous question.
constexpr unsigned kProcessorsForOne = 4;

int questions_at_once() {
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency() / kProcessorsForOne));
}

std::string asker_of(const Request& request) {
  if (!request.principal) return "at " + request.peer;
  if (request.principal->kiosk) return "kiosk " + to_string(request.principal->kiosk->id);
  return request.user();
}

}  // namespace

QuestionDesk::QuestionDesk(Options options)
    : options_(options), turns_(std::make_shared<QuestionTurns>(questions_at_once())) {
  for (int i = 0; i < options_.threads; ++i) threads_.emplace_back([this] { run(); });
}

std::shared_ptr<Question> QuestionDesk::begin(const Request& request) {
  const Role role = request.principal ? request.role() : Role::guest;
  auto question = std::make_shared<Question>(asker_of(request), limits_of(role), turns_);
  const std::lock_guard lock(mutex_);
  std::erase_if(questions_, [](const auto& each) { return each.expired(); });
  questions_.push_back(question);
  if (over_) question->end(*over_);
  return question;
}

Result<void> QuestionDesk::post(const std::shared_ptr<Question>& question,
                                std::function<void()> work) {
  const std::lock_guard lock(mutex_);
  if (stopping_)
    return fail(ErrorCode::unavailable, "Server is stopping",
                "The server is shutting down. Try again when it is running again.");
  Person& person = people_[question->asker()];
  if (person.waiting.size() >= options_.of_one_waiting)
    return fail(ErrorCode::too_many_requests, "Too many queries",
                std::to_string(options_.of_one_waiting) +
                    " of your queries are waiting. Try again when the server has answered some of "
                    "them.");
  if (waiting_ >= options_.waiting) {
    if (person.waiting.empty() && person.under_way == 0) people_.erase(question->asker());
    return fail(ErrorCode::busy, "Server is busy",
                "Too many queries are waiting. Try again in a moment.");
  }
  person.waiting.push_back({question, std::move(work)});
  ++waiting_;
  changed_.notify_one();
  return {};
}

QuestionDesk::People::iterator QuestionDesk::next() {
  auto first = people_.end();
  for (auto person = people_.begin(); person != people_.end(); ++person) {
    const Person& its = person->second;
    if (its.waiting.empty()) continue;
    // Ignores the limit while the desk is stopping.
    if (its.under_way >= options_.of_one_at_once && !stopping_) continue;
    const auto order = [](const Person& p) { return std::pair(p.under_way, p.last_begun); };
    if (first == people_.end() || order(its) < order(first->second)) first = person;
  }
  return first;
}

void QuestionDesk::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return next() != people_.end() || (stopping_ && waiting_ == 0); });
    const auto person = next();
    if (person == people_.end()) return;
    const std::string name = person->first;
    Task task = std::move(person->second.waiting.front());
    person->second.waiting.pop_front();
    ++person->second.under_way;
    person->second.last_begun = ++begun_;
    --waiting_;
    ++under_way_;
    lock.unlock();
    {
      const Question::Scope scope(task.question);
      task.work();
      task = {};
    }
    lock.lock();
    --under_way_;
    const auto done = people_.find(name);
    if (--done->second.under_way == 0 && done->second.waiting.empty()) people_.erase(done);
    changed_.notify_all();
  }
}

void QuestionDesk::end_all(const Error& why) {
  std::vector<std::shared_ptr<Question>> live;
  {
    const std::lock_guard lock(mutex_);
    over_ = why;
    for (const auto& each : questions_)
      if (auto question = each.lock()) live.push_back(std::move(question));
  }
  for (const auto& question : live) question->end(why);
}

void QuestionDesk::stop() {
  end_all({ErrorCode::unavailable,
           "Server is stopping",
           "The server is shutting down. Try again when it is running again.",
           {}});
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  for (auto& thread : threads_)
    if (thread.joinable()) thread.join();
}

std::size_t QuestionDesk::waiting() const {
  const std::lock_guard lock(mutex_);
  return waiting_;
}

std::size_t QuestionDesk::under_way() const {
  const std::lock_guard lock(mutex_);
  return under_way_;
}

}  // namespace strata::net
