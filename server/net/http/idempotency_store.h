#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_set>

#include "net/http/http_types.h"
#include "store/content/idempotent_response.h"
#include "store/store.h"

namespace strata::net {

// Idempotency-Key: the first successful answer to a key is kept in the database, in the transaction
// of what the call did, and given again to a repeat. A key belongs to one person, method and
// address; the same key with another body is refused (422), and a repeat while the first call is
// still at work too (409). Refusals are not kept: the call changed nothing and may be tried again.
// Thread-safe, blocks.
class IdempotencyStore {
 public:
  explicit IdempotencyStore(store::Store& store) : store_(store) {}

  // What was kept for the request's key, or nothing when the call is new: then `end` must follow.
  Result<std::optional<nlohmann::json>> begin(const Request& request);
  void end(const Request& request);

 private:
  store::Store& store_;
  std::mutex mutex_;
  std::unordered_set<std::string> at_work_;
};

// Under which the answer to a request is kept; empty when it has no key.
std::string scoped_key(const Request& request);
// Tells requests with one key apart.
std::string fingerprint(const Request& request);

nlohmann::json kept_answer(const Response& response, std::string request_fingerprint);
Response response_of(const nlohmann::json& kept);

// For the call that has the effect: keeps `respond(effect)` with it where the request has a key.
template <class... Effect>
store::IdempotentResponse<Effect...> idempotent_response(
    const Request& request,
    std::type_identity_t<std::function<Response(const Effect&...)>> respond) {
  return {scoped_key(request),
          [print = fingerprint(request), respond = std::move(respond)](const Effect&... effect) {
            return kept_answer(respond(effect...), print);
          },
          request.user()};
}

}  // namespace strata::net
