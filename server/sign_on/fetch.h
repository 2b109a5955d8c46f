#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"

namespace strata::sign_on {

struct HttpCall {
  std::string url;
  std::optional<std::string> form{};   // sent with POST; otherwise the call is a GET
  std::vector<std::string> headers{};  // "Name: value"
};
struct HttpReply {
  long status = 0;
  std::string body;
};
using Fetch = std::function<Result<HttpReply>(const HttpCall&)>;

inline constexpr std::size_t kMaxReply = 512u << 10;  // bytes

// Sends one request to a provider, at most 10 seconds long, and follows no redirect. Returns a
// `bad_gateway` error for a URL that is not safe (core/text/url.h), for a reply that is too long,
// and if the provider cannot be reached. Blocks, so call it on a worker.
Result<HttpReply> fetch(const HttpCall& call);

}  // namespace strata::sign_on
