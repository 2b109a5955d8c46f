#include "net/import_book.h"

#include "net/answer_book.h"

namespace strata::net {

Result<std::optional<std::int64_t>> ImportBook::find(const Request& request) {
  std::lock_guard lock(mutex_);
  const auto found = started_.find(scoped_key(request));
  if (found == started_.end() || !jobs_.status(found->second.job)) return std::nullopt;
  if (found->second.fingerprint != fingerprint(request))
    return fail(422, "Key used for another call",
                "This Idempotency-Key was used with another file; take a new key for a new import.", "Idempotency-Key");
  return found->second.job;
}

void ImportBook::started(const Request& request, std::int64_t job) {
  const std::string key = scoped_key(request);
  if (key.empty()) return;
  std::lock_guard lock(mutex_);
  std::erase_if(started_, [&](const auto& entry) { return !jobs_.status(entry.second.job); });
  started_[key] = {job, fingerprint(request)};
}

Result<std::int64_t> ImportBook::finished(const Request& request, std::int64_t model) {
  auto job = jobs_.add([model](Progress&) -> Result<std::int64_t> { return model; });
  if (job) started(request, *job);
  return job;
}

}  // namespace strata::net
