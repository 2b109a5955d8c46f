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

// Bodies in files are told apart by their length: hashing gigabytes to compare a retry is not worth
// it.
std::string fingerprint(const Request& request) {
  return request.body_file.empty() ? sha256_hex(request.body)
                                   : "file:" + std::to_string(request.body_bytes);
}

nlohmann::json kept_answer(const Response& response, std::string request_fingerprint) {
  nlohmann::json headers = nlohmann::json::array();
  for (const auto& [header, value] : response.headers) headers.push_back({header, value});
  return {{"request", std::move(request_fingerprint)},
          {"status", response.status},
          {"headers", std::move(headers)},
          {"body", response.body}};
}

Response response_of(const nlohmann::json& kept) {
  Response response;
  response.status = kept.value("status", 200);
  for (const auto& header : kept.at("headers"))
    response.with(header.at(0).get<std::string>(), header.at(1).get<std::string>());
  response.body = kept.value("body", std::string());
  return response;
}

Result<std::optional<nlohmann::json>> IdempotencyStore::begin(const Request& request) {
  const std::string scoped = scoped_key(request);
  {
    std::lock_guard lock(mutex_);
    if (!at_work_.insert(scoped).second)
      return fail(ErrorCode::conflict, "Still at work",
                  "The first call with this Idempotency-Key has not ended yet; ask again later.",
                  "Idempotency-Key");
  }
  auto kept = store_.answers().find(scoped);
  if (kept && *kept && (*kept)->value("request", std::string()) != fingerprint(request))
    kept = fail(ErrorCode::invalid, "Key used for another call",
                "This Idempotency-Key was used with another body; take a new key for a new call.",
                "Idempotency-Key");
  if (!kept || *kept) end(request);
  return kept;
}

void IdempotencyStore::end(const Request& request) {
  std::lock_guard lock(mutex_);
  at_work_.erase(scoped_key(request));
}

}  // namespace strata::net
