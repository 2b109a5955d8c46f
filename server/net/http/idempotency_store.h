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

// Idempotency-Key: stores the first successful answer to a key in the database, in the transaction
// of the call's effect, and returns it to a repeat. A key belongs to one user, method and address.
// Refuses the same key with another body (422), and a repeat while the first call is still running
// (409). Refusals are not stored: the call changed nothing and may be retried. Thread-safe, blocks.
class IdempotencyStore {
 public:
  explicit IdempotencyStore(store::Store& store) : store_(store) {}

  // Returns the stored answer for the request's key. Nothing: the call is new; call `end` later.
  Result<std::optional<nlohmann::json>> begin(const Request& request);
  void end(const Request& request);

 private:
  store::Store& store_;
  std::mutex mutex_;
  std::unordered_set<std::string> at_work_;
};

// The key under which the answer is stored; empty if the request has none.
std::string scoped_key(const Request& request);
// Distinguishes requests with the same key.
std::string fingerprint(const Request& request);

nlohmann::json stored_answer(const Response& response, std::string request_fingerprint);
Response response_of(const nlohmann::json& stored);

// For the call with the effect: stores `respond(effect)` with it if the request has a key.
template <class... Effect>
store::IdempotentResponse<Effect...> idempotent_response(
    const Request& request,
    std::type_identity_t<std::function<Response(const Effect&...)>> respond) {
  return {scoped_key(request),
          [print = fingerprint(request), respond = std::move(respond)](const Effect&... effect) {
            return stored_answer(respond(effect...), print);
          },
          request.user()};
}

}  // namespace strata::net
