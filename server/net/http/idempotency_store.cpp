#include "net/http/idempotency_store.h"

#include "core/digest.h"
#include "store/content/answers.h"

namespace strata::net {

std::string scoped_key(const Request& request) {
  const std::string_view key = request.header("idempotency-key");
  if (key.empty()) return {};
  return sha256_hex(request.user() + '\n' + std::string(name(request.method)) + '\n' +
                    request.target + '\n' + std::string(key));
}

// Identifies a body in a file only by its length because hashing gigabytes for a retry is too slow.
std::string fingerprint(const Request& request) {
  return request.body_file.empty() ? sha256_hex(request.body)
                                   : "file:" + std::to_string(request.body_bytes);
}

nlohmann::json stored_answer(const Response& response, std::string request_fingerprint) {
  nlohmann::json headers = nlohmann::json::array();
  for (const auto& [header, value] : response.headers) headers.push_back({header, value});
  return {{"request", std::move(request_fingerprint)},
          {"status", response.status},
          {"headers", std::move(headers)},
          {"body", response.body}};
}

Response response_of(const nlohmann::json& stored) {
  Response response;
  response.status = stored.value("status", 200);
  for (const auto& header : stored.at("headers"))
    response.with(header.at(0).get<std::string>(), header.at(1).get<std::string>());
  response.body = stored.value("body", std::string());
  return response;
}

Result<std::optional<nlohmann::json>> IdempotencyStore::begin(const Request& request) {
  const std::string scoped = scoped_key(request);
  {
    std::lock_guard lock(mutex_);
    if (!at_work_.insert(scoped).second)
      return fail(ErrorCode::conflict, "Request still running",
                  "The first request with this Idempotency-Key is still running. Try again later.",
                  "Idempotency-Key");
  }
  auto stored = store_.answers().find(scoped);
  if (stored && *stored && (*stored)->value("request", std::string()) != fingerprint(request))
    stored =
        fail(ErrorCode::invalid, "Idempotency-Key already used",
             "A request with another body has used this Idempotency-Key. Use a new key for a new "
             "request.",
             "Idempotency-Key");
  if (!stored || *stored) end(request);
  return stored;
}

void IdempotencyStore::end(const Request& request) {
  std::lock_guard lock(mutex_);
  at_work_.erase(scoped_key(request));
}

}  // namespace strata::net
