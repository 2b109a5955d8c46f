#include "app/edits.h"

#include <utility>

#include "domain/people/question.h"
#include "room/caches/await.h"
#include "room/edit.h"
#include "room/edits.h"

namespace strata::app {

Result<room::EditAnswer> edit_and_wait(room::Room& room, room::EditRequest edit,
                                       EditCounters& counters) {
  if (!edit.trace) edit.trace = current_trace();
  if (Question* question = Question::current()) edit.question = question->shared_from_this();
  auto answer = room::await<room::EditAnswer>([&](auto saved) {
    room.edits().submit(
        std::move(edit), [&counters](const room::EditAnswer&) { ++counters.applied; },
        std::move(saved));
  });
  ++(answer ? counters.saved : counters.refused);
  return answer;
}

}  // namespace strata::app
