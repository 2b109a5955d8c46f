#include "net/http/job_idempotency.h"

#include "net/http/idempotency_store.h"

namespace strata::net {

Result<std::optional<JobId>> JobIdempotency::find(const Request& request) {
  std::lock_guard lock(mutex_);
  const auto found = started_.find(scoped_key(request));
  if (found == started_.end() || !jobs_.status(found->second.job)) return std::nullopt;
  if (found->second.fingerprint != fingerprint(request))
    return fail(
        ErrorCode::invalid, "Idempotency-Key already used",
        "A request with another body has used this Idempotency-Key. Use a new key for a new request.",
        "Idempotency-Key");
  return found->second.job;
}

void JobIdempotency::started(const Request& request, JobId job) {
  const std::string key = scoped_key(request);
  if (key.empty()) return;
  std::lock_guard lock(mutex_);
  std::erase_if(started_, [&](const auto& entry) { return !jobs_.status(entry.second.job); });
  started_[key] = {job, fingerprint(request)};
}

Result<JobId> JobIdempotency::finished(const Request& request, ProjectId project,
                                       jobs::JobResult result, jobs::JobKind kind) {
  auto job = jobs_.add(
      project,
      [result = std::move(result)](Progress&) -> Result<jobs::JobResult> { return result; },
      request.user(), kind);
  if (job) started(request, *job);
  return job;
}

}  // namespace strata::net
