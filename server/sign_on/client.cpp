#include "sign_on/client.h"

#include <algorithm>
#include <utility>

#include "core/digest.h"
#include "core/secret.h"
#include "core/text/base64.h"
#include "core/text/bytes.h"
#include "core/text/percent.h"
#include "core/text/url.h"
#include "sign_on/id_token.h"

namespace strata::sign_on {
namespace {

using nlohmann::json;

constexpr std::chrono::hours kRemember{1};
constexpr std::chrono::seconds kRetry{5};        // after the provider did not respond
constexpr std::chrono::seconds kReloadKeys{30};  // between two loads because of unknown keys
constexpr std::size_t kMaxError = 100;

tl::unexpected<Error> broken(const std::string& what) {
  return fail(ErrorCode::bad_gateway, "Provider does not work", what);
}
tl::unexpected<Error> refused(const std::string& why) {
  return fail(ErrorCode::unauthenticated, "Sign-in refused", why);
}

std::string text_of(const json& object, const char* member) {
  const auto found = object.find(member);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

bool lists(const json& object, const char* member, const char* value) {
  const auto found = object.find(member);
  return found != object.end() && found->is_array() &&
         std::ranges::find(*found, json(value)) != found->end();
}

std::string form_of(const std::vector<std::pair<std::string, std::string>>& fields) {
  std::string form;
  for (const auto& [name, value] : fields)
    form += (form.empty() ? "" : "&") + name + "=" + percent_encode(value);
  return form;
}

// Returns the JSON object of a successful reply.
Result<json> object_in(const Result<HttpReply>& reply, const std::string& url) {
  if (!reply) return tl::unexpected(reply.error());
  if (reply->status != 200)
    return broken(url + " responded with the status " + std::to_string(reply->status) + ".");
  auto object = json::parse(reply->body, nullptr, false);
  if (!object.is_object()) return broken(url + " did not respond with a JSON object.");
  return object;
}

// The name of an OAuth error, without characters that do not belong to such a name.
std::string error_name(const std::string& body) {
  const json object = json::parse(body, nullptr, false);
  std::string name = object.is_object() ? text_of(object, "error") : std::string();
  name.resize(std::min(name.size(), kMaxError));
  std::erase_if(name, [](char c) { return !((c >= 'a' && c <= 'z') || c == '_'); });
  return name;
}

}  // namespace

Handshake Handshake::make() { return {random_token(), random_token(), random_token()}; }

Client::Client(Provider provider, Fetch fetch, Clock clock)
    : provider_(std::move(provider)), fetch_(std::move(fetch)), clock_(std::move(clock)) {}

Result<Client::Endpoints> Client::load_endpoints_locked() const {
  std::string url = provider_.issuer;
  while (url.ends_with('/')) url.pop_back();
  url += "/.well-known/openid-configuration";
  const auto document = STRATA_TRY(object_in(fetch_({.url = url}), url));
  if (text_of(document, "issuer") != provider_.issuer)
    return broken(url + " has an issuer that differs from the configuration.");
  Endpoints found;
  found.authorization = text_of(document, "authorization_endpoint");
  found.token = text_of(document, "token_endpoint");
  found.keys = text_of(document, "jwks_uri");
  found.userinfo = text_of(document, "userinfo_endpoint");
  for (const std::string* each : {&found.authorization, &found.token, &found.keys})
    if (!is_safe_url(*each))
      return broken(url + ": an address is missing or does not begin with https.");
  if (provider_.userinfo && !is_safe_url(found.userinfo))
    return broken(url + " has no address for user information.");
  constexpr const char* kMethods = "token_endpoint_auth_methods_supported";
  found.secret_in_form = lists(document, kMethods, "client_secret_post") &&
                         !lists(document, kMethods, "client_secret_basic");
  const auto sends = document.find("authorization_response_iss_parameter_supported");
  found.sends_issuer = sends != document.end() && *sends == true;
  return found;
}

Result<Client::Endpoints> Client::endpoints() {
  const std::lock_guard lock(mutex_);
  const Time now = clock_();
  if (now < endpoints_until_) {
    if (endpoints_) return *endpoints_;
    if (failure_) return tl::unexpected(*failure_);
  }
  auto loaded = load_endpoints_locked();
  if (loaded) {
    endpoints_ = std::move(*loaded);
    endpoints_until_ = now + kRemember;
    return *endpoints_;
  }
  // An old document is better than none. The next requests do not wait for the provider again.
  endpoints_until_ = clock_() + kRetry;
  failure_ = loaded.error();
  if (endpoints_) return *endpoints_;
  return loaded;
}

Result<KeySet> Client::keys_for(const std::string& token, const std::string& address) {
  const auto header = STRATA_TRY(read_token_header(token));
  const std::lock_guard lock(mutex_);
  const Time now = clock_();
  const bool is_known = keys_.has(header.algorithm, header.kid);
  if (now < keys_loaded_ + (is_known ? std::chrono::seconds(kRemember) : kReloadKeys)) {
    if (!is_known && keys_failure_) return tl::unexpected(*keys_failure_);
    return keys_;
  }
  keys_loaded_ = now;  // also after a failure, so that forged tokens cause few requests
  const auto reply = fetch_({.url = address});
  auto loaded =
      object_in(reply, address).and_then([&](const json&) { return KeySet::parse(reply->body); });
  keys_failure_ = loaded ? std::nullopt : std::optional(loaded.error());
  if (loaded)
    keys_ = std::move(*loaded);
  else if (!is_known)
    return loaded;
  return keys_;
}

Result<std::string> Client::authorization_url(const std::string& redirect_uri,
                                              const Handshake& handshake) {
  const auto found = STRATA_TRY(endpoints());
  std::string scope;
  for (const std::string& each : provider_.scopes) scope += (scope.empty() ? "" : " ") + each;
  const std::string challenge = to_base64url(sha256(handshake.code_verifier));
  const bool has_query = found.authorization.find('?') != std::string::npos;
  return found.authorization + (has_query ? "&" : "?") +
         form_of({{"response_type", "code"},
                  {"client_id", provider_.client_id},
                  {"redirect_uri", redirect_uri},
                  {"scope", scope},
                  {"state", handshake.state},
                  {"nonce", handshake.nonce},
                  {"code_challenge", challenge},
                  {"code_challenge_method", "S256"}});
}

Result<json> Client::exchange(const Endpoints& found, const std::string& code,
                              const std::string& redirect_uri,
                              const std::string& code_verifier) const {
  std::vector<std::pair<std::string, std::string>> fields{{"grant_type", "authorization_code"},
                                                          {"code", code},
                                                          {"redirect_uri", redirect_uri},
                                                          {"code_verifier", code_verifier}};
  HttpCall call{.url = found.token};
  if (provider_.client_secret.empty() || found.secret_in_form) {
    fields.emplace_back("client_id", provider_.client_id);
    if (!provider_.client_secret.empty())
      fields.emplace_back("client_secret", provider_.client_secret);
  } else {
    const std::string pair =
        percent_encode(provider_.client_id) + ":" + percent_encode(provider_.client_secret);
    call.headers.push_back("Authorization: Basic " + to_base64(bytes_of(pair)));
  }
  call.form = form_of(fields);
  const auto reply = STRATA_TRY(fetch_(call));
  if (reply.status >= 400 && reply.status < 500) {
    const std::string name = error_name(reply.body);
    if (name == "invalid_grant") return refused("The provider refused the code (invalid_grant).");
    return broken("The provider refused the request for the token" +
                  (name.empty() ? std::string() : " (" + name + ")") +
                  ". Check the client in the configuration.");
  }
  return object_in(reply, found.token);
}

Result<void> Client::add_userinfo(const Endpoints& found, const json& reply, json& claims) const {
  const std::string access = text_of(reply, "access_token");
  const bool is_plain = std::ranges::all_of(access, [](char c) { return c > ' ' && c < 0x7f; });
  if (access.empty() || !is_plain) return broken("The provider returned no access token.");
  const auto more = STRATA_TRY(
      object_in(fetch_({.url = found.userinfo, .headers = {"Authorization: Bearer " + access}}),
                found.userinfo));
  if (text_of(more, "sub") != text_of(claims, "sub"))
    return refused("The user information is about another person.");
  for (const auto& [name, value] : more.items())
    if (!claims.contains(name)) claims[name] = value;
  return {};
}

Result<json> Client::claims(const Callback& callback, const std::string& redirect_uri,
                            const Handshake& handshake) {
  const auto found = STRATA_TRY(endpoints());
  if (callback.issuer ? *callback.issuer != provider_.issuer : found.sends_issuer)
    return refused("The response is from another provider.");
  const auto reply =
      STRATA_TRY(exchange(found, callback.code, redirect_uri, handshake.code_verifier));
  const std::string token = text_of(reply, "id_token");
  if (token.empty()) return broken("The provider returned no ID token.");
  const auto keys = STRATA_TRY(keys_for(token, found.keys));
  auto claims = STRATA_TRY(verify_id_token(
      token, keys, {provider_.issuer, provider_.client_id, handshake.nonce, clock_()}));
  if (provider_.userinfo) STRATA_TRY(add_userinfo(found, reply, claims));
  return claims;
}

}  // namespace strata::sign_on
