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

// Implements Idempotency-Key. Stores the first successful response to a key in the database, in the
// same transaction as the effect of the call. Returns the stored response to a repeated call. A key
// is valid for one user, method and address. Refuses the same key with another body (422), and a
// repeated call while the first call is running (409). Refusals are not stored because the call
// changed nothing and may be retried. Thread-safe, blocks.
class IdempotencyStore {
 public:
  explicit IdempotencyStore(store::Store& store) : store_(store) {}

  // Returns the stored response for the request's key. Returns nothing if the call is new. In that
  // case, call `end` later.
  Result<std::optional<nlohmann::json>> begin(const Request& request);
  void end(const Request& request);

 private:
  store::Store& store_;
  std::mutex mutex_;
  std::unordered_set<std::string> at_work_;
};

// Returns the key under which the response is stored. Returns an empty text if the request has no
// key.
std::string scoped_key(const Request& request);
// Returns a text that distinguishes requests with the same key.
std::string fingerprint(const Request& request);

nlohmann::json stored_answer(const Response& response, std::string request_fingerprint);
Response response_of(const nlohmann::json& stored);

// Stores `respond(effect)` together with the effect of the call, if the request has a key.
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
