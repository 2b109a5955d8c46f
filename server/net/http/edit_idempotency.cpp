#include "net/http/edit_idempotency.h"
#include "store/journal/journal_reads.h"

namespace strata::net {
namespace {

tl::unexpected<Error> used_for_another() {
  return fail(ErrorCode::invalid, "Idempotency-Key already used",
              "Another edit has used this Idempotency-Key. Use a new key for a new edit.",
              "Idempotency-Key");
}

}  // namespace

Result<void> EditIdempotency::begin(ModelId model_id, const room::EditRequest& edit) {
  {
    std::lock_guard lock(mutex_);
    AtWork& at_work = at_work_[edit.id];
    if (at_work.calls > 0 && at_work.record != edit.record) return used_for_another();
    at_work.record = edit.record;
    ++at_work.calls;
  }
  auto journal = store_.journal().state(model_id, std::span(&edit.id, 1));
  Result<void> good;
  if (!journal)
    good = tl::unexpected(journal.error());
  else if (!journal->known.empty() && journal->known.front().record != edit.record)
    good = used_for_another();
  if (!good) end(edit.id);
  return good;
}

void EditIdempotency::end(const Uuid& id) {
  std::lock_guard lock(mutex_);
  if (const auto found = at_work_.find(id); --found->second.calls == 0) at_work_.erase(found);
}

}  // namespace strata::net
