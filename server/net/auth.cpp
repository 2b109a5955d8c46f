#include "net/auth.h"

#include "net/digest.h"
#include "net/origin.h"

namespace strata::net {
namespace {

constexpr std::chrono::seconds kRememberFor{10};
constexpr std::size_t kMaxRemembered = 4096;
constexpr std::size_t kMaxTokenLength = 512;
constexpr std::string_view kScheme = "bearer ";

tl::unexpected<Problem> unknown_secret() {
  return fail(401, "Not signed in",
              "This token or session is unknown, expired or revoked. Sign in again, or make a new token.");
}

}  // namespace

Authenticator::Authenticator(store::Store& store, std::string owner_token)
    : store_(store), owner_token_(std::move(owner_token)) {}

Result<std::optional<Principal>> Authenticator::identify_token(const std::string& token) {
  if (token.empty() || token.size() > kMaxTokenLength) return std::nullopt;
  if (!owner_token_.empty() && equal_in_constant_time(token, owner_token_))
    return Principal{"owner", Role::owner, false};
  const auto now = std::chrono::steady_clock::now();
  const std::string key = sha256_hex(token);
  {
    std::lock_guard lock(mutex_);
    if (auto found = remembered_.find(key); found != remembered_.end()) {
      if (found->second.until > now) return found->second.principal;
      remembered_.erase(found);
    }
  }
  auto stored = store_.find_token(token);
  if (!stored) return tl::unexpected(stored.error());
  // An owner link is traded for a session; it is no token of its own.
  if (!*stored || (*stored)->kind == store::Store::TokenKind::owner_link) return std::nullopt;
  Principal principal{(*stored)->user, parse_role((*stored)->role).value_or(Role::viewer), false};
  std::lock_guard lock(mutex_);
  if (remembered_.size() >= kMaxRemembered) remembered_.clear();
  remembered_[key] = {principal, now + kRememberFor};
  return principal;
}

std::string Authenticator::secret_of(const Request& request) {
  const std::string authorization(request.header("authorization"));
  if (authorization.empty()) return cookie_value(request.header("cookie"), kSessionCookie);
  return to_lower(authorization.substr(0, kScheme.size())) == kScheme ? authorization.substr(kScheme.size())
                                                                      : std::string();
}

Result<std::optional<Principal>> Authenticator::identify(const Request& request) {
  const bool by_cookie = request.header("authorization").empty();
  const std::string secret = secret_of(request);
  if (secret.empty() && by_cookie) return std::nullopt;
  if (secret.empty()) return fail(401, "Not signed in", "The Authorization header is `Bearer TOKEN`.", "Authorization");
  auto principal = identify_token(secret);
  if (!principal) return principal;
  if (!*principal) return unknown_secret();
  (*principal)->by_cookie = by_cookie;
  return principal;
}

Result<std::string> Authenticator::session_for_token(const std::string& token) {
  auto principal = identify_token(token);
  if (!principal) return tl::unexpected(principal.error());
  if (!*principal) {
    if (token.size() > kMaxTokenLength) return unknown_secret();
    auto by_link = store_.redeem_owner_link(token, kSessionLifetime);
    if (!by_link) return tl::unexpected(by_link.error());
    if (!*by_link) return unknown_secret();
    return **by_link;
  }
  return store_.create_token(store::Store::TokenKind::session, (*principal)->user,
                             std::string(name((*principal)->role)), kSessionLifetime);
}

Result<std::string> Authenticator::session_for_link(const std::string& link) {
  auto session = store_.redeem_owner_link(link, kSessionLifetime);
  if (!session) return tl::unexpected(session.error());
  if (!*session)
    return fail(401, "Link not valid",
                "This sign-in link is unknown or revoked. The server prints a valid one when it starts.", "link");
  return **session;
}

Result<void> Authenticator::end_session(const std::string& session_token) {
  {
    std::lock_guard lock(mutex_);
    remembered_.erase(sha256_hex(session_token));
  }
  return store_.revoke_token(session_token);
}

std::string Authenticator::set_cookie(const std::string& session_token, bool secure) {
  return std::string(kSessionCookie) + "=" + session_token + "; Path=/; HttpOnly; SameSite=Strict; Max-Age=" +
         std::to_string(std::chrono::seconds(kSessionLifetime).count()) + (secure ? "; Secure" : "");
}

std::string Authenticator::clear_cookie(bool secure) {
  return std::string(kSessionCookie) + "=; Path=/; HttpOnly; SameSite=Strict; Max-Age=0" + (secure ? "; Secure" : "");
}

}  // namespace strata::net
