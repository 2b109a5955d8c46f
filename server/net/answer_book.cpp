#include "net/answer_book.h"

#include "core/log.h"
#include "net/digest.h"

namespace strata::net {
namespace {

// Bodies in files are told apart by their length: hashing gigabytes to compare a retry is not worth it.
std::string fingerprint(const Request& request) {
  return request.body_file.empty() ? sha256_hex(request.body) : "file:" + std::to_string(request.body_bytes);
}

}  // namespace

std::string AnswerBook::scoped_key(const Request& request, std::string_view key) {
  return sha256_hex(request.user() + '\n' + std::string(name(request.method)) + '\n' + request.target + '\n' + std::string(key));
}

Result<std::optional<Response>> AnswerBook::begin(const Request& request, std::string_view key) {
  const std::string scoped = scoped_key(request, key);
  {
    std::lock_guard lock(mutex_);
    if (!at_work_.insert(scoped).second)
      return fail(409, "Still at work", "The first call with this Idempotency-Key has not ended yet; ask again later.", "Idempotency-Key");
  }
  auto release = [&] {
    std::lock_guard lock(mutex_);
    at_work_.erase(scoped);
  };
  auto stored = store_.find_answer(scoped);
  if (!stored) {
    release();
    return tl::unexpected(stored.error());
  }
  if (!*stored) return std::nullopt;
  release();
  const nlohmann::json& kept = **stored;
  if (kept.value("request", std::string()) != fingerprint(request))
    return fail(422, "Key used for another call", "This Idempotency-Key was used with another body; take a new key for a new call.", "Idempotency-Key");
  Response response;
  response.status = kept.value("status", 200);
  for (const auto& header : kept.at("headers")) response.with(header.at(0).get<std::string>(), header.at(1).get<std::string>());
  response.body = kept.value("body", std::string());
  response.with("Idempotency-Replayed", "true");
  return response;
}

void AnswerBook::finish(const Request& request, std::string_view key, const Response& response) {
  const std::string scoped = scoped_key(request, key);
  if (response.status < 300) {
    nlohmann::json headers = nlohmann::json::array();
    for (const auto& [header, value] : response.headers) headers.push_back({header, value});
    auto kept = store_.keep_answer(scoped, {{"request", fingerprint(request)},
                                            {"status", response.status},
                                            {"headers", std::move(headers)},
                                            {"body", response.body}});
    if (!kept) log::warning("an answer could not be kept for repeats: " + kept.error().detail);
  }
  std::lock_guard lock(mutex_);
  at_work_.erase(scoped);
}

}  // namespace strata::net
