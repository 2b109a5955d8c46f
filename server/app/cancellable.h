#pragma once

#include <memory>

#include "core/progress.h"
#include "domain/people/question.h"

namespace strata::app {

// Calls `work`, which returns a Result. Computations on texels check the current Question and not a
// Progress, so a job calls them as a question that ends when the job is cancelled. A request has a
// question already, with its own limits.
template <class Work>
auto cancellable(Progress& progress, const Work& work) -> decltype(work()) {
  if (Question::current()) return work();
  const auto question = std::make_shared<Question>("", QuestionLimits{}, nullptr);
  const Progress::WhenCancelled when_cancelled(
      progress, [question] { question->end(cancelled_problem().value()); });
  const Question::Scope scope(question);
  try {
    return work();
  } catch (const QuestionEnded& ended) {
    return tl::unexpected(ended.problem());
  }
}

}  // namespace strata::app
