#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <unordered_set>

#include "net/http_types.h"
#include "store/store.h"

namespace strata::net {

// Idempotency-Key: the first successful answer to a key is kept in the database and given again to a repeat. A key belongs to
// one person, method and address; the same key with another body is refused (422), and a repeat while the first call is still
// at work too (409). Refusals are not kept: the call changed nothing and may be tried again. Thread-safe, blocks.
class AnswerBook {
 public:
  explicit AnswerBook(store::Store& store) : store_(store) {}

  // The kept answer, or nothing when the call is new: then `finish` must follow.
  Result<std::optional<Response>> begin(const Request& request, std::string_view key);
  void finish(const Request& request, std::string_view key, const Response& response);

  static std::string scoped_key(const Request& request, std::string_view key);

 private:
  store::Store& store_;
  std::mutex mutex_;
  std::unordered_set<std::string> at_work_;
};

}  // namespace strata::net
