#include "net/auth/auth.h"

#include "core/digest.h"
#include "core/secret.h"
#include "core/text/base64.h"
#include "net/http/origin.h"
#include "store/people/accounts.h"
#include "store/people/kiosks.h"
#include "store/people/password.h"
#include "store/people/tokens.h"

namespace strata::net {
namespace {

constexpr std::chrono::seconds kRememberFor{10};
constexpr std::size_t kMaxRemembered = 4096;
constexpr std::size_t kMaxTokenLength = 512;
constexpr std::string_view kScheme = "bearer ", kBasic = "basic ";

tl::unexpected<Error> unknown_secret() {
  return fail(ErrorCode::unauthenticated, "Not signed in",
              "This token or session does not exist, has expired or was revoked. Sign in again, or "
              "create a new token.");
}

constexpr std::string_view kKioskPrefix = "kiosk ", kHostPrefix = "__Host-";

Principal principal_of(const store::Kiosk& kiosk) {
  Principal principal{kiosk_name(kiosk.id), Role::guest};
  principal.roles.in_projects[kiosk.project_id] = Role::viewer;
  principal.kiosk = KioskPass{kiosk.id, kiosk.model_id, kiosk.tour_id};
  return principal;
}

std::string cookie_of(std::string_view name, const std::string& value,
                      std::chrono::seconds lifetime, bool secure,
                      std::string_view same_site = "Strict") {
  return std::string(secure ? kHostPrefix : "") + std::string(name) + "=" + value +
         "; Path=/; HttpOnly; SameSite=" + std::string(same_site) +
         "; Max-Age=" + std::to_string(lifetime.count()) + (secure ? "; Secure" : "");
}

// Many GIS programs can only send a user name and a password (RFC 7617). The token is then the
// password. A browser may repeat such a header without being asked, so only reads accept it.
bool accepts_basic(const Request& request) {
  return (request.method == Method::get || request.method == Method::head) &&
         !request.segments.empty() && request.segments.front() == "ogc";
}

// Returns the password of a header, and an empty text if the header has another form.
std::string basic_password(std::string_view authorization) {
  if (to_lower(authorization.substr(0, kBasic.size())) != kBasic) return {};
  const auto bytes = from_base64(authorization.substr(kBasic.size()));
  if (!bytes) return {};
  const std::string text(bytes->begin(), bytes->end());
  const auto colon = text.find(':');
  return colon == std::string::npos ? std::string() : text.substr(colon + 1);
}

}  // namespace

std::string kiosk_name(KioskId id) { return std::string(kKioskPrefix) + to_string(id); }
bool is_kiosk_name(const std::string& user) { return user.starts_with(kKioskPrefix); }

Authenticator::Authenticator(store::Store& store, std::string owner_token, bool local_accounts)
    : store_(store), owner_token_(std::move(owner_token)), local_accounts_(local_accounts) {}

Result<std::optional<Principal>> Authenticator::identify_token(const std::string& token) {
  if (token.empty() || token.size() > kMaxTokenLength) return std::nullopt;
  if (!owner_token_.empty() && equal_in_constant_time(token, owner_token_)) return owner_by_token();
  const auto now = std::chrono::steady_clock::now();
  const std::string key = sha256_hex(token);
  std::uint64_t changes = 0;
  {
    std::lock_guard lock(mutex_);
    changes = changes_;
    if (auto found = remembered_.find(key); found != remembered_.end()) {
      if (found->second.until > now) return found->second.principal;
      remembered_.erase(found);
    }
  }
  auto stored = STRATA_TRY(store_.tokens().find(token));
  // Links are not tokens. A client exchanges a link for a session.
  using store::TokenKind;
  if (stored && stored->kind != TokenKind::session && stored->kind != TokenKind::script)
    return std::nullopt;
  Principal principal;
  if (stored) {
    const Roles& roles = stored->roles;
    principal = {stored->user,  roles.everywhere,
                 false,         stored->kind == TokenKind::script,
                 stored->token, roles};
  } else {
    auto kiosk = STRATA_TRY(store_.kiosks().find(token));
    if (!kiosk) return std::nullopt;
    principal = principal_of(*kiosk);
  }
  std::lock_guard lock(mutex_);
  if (changes != changes_) return principal;  // the result may predate the change
  if (remembered_.size() >= kMaxRemembered) remembered_.clear();
  remembered_[key] = {principal, now + kRememberFor};
  return principal;
}

// The token loses the owner role as soon as an administrator can sign in with a password. Access to
// the environment must not make somebody the permanent owner.
Result<Principal> Authenticator::owner_by_token() {
  const auto principal = [](bool is_script) {
    const Role role = is_script ? Role::administrator : Role::owner;
    return Principal{.user = "owner", .role = role, .is_script = is_script, .roles = {role, {}}};
  };
  const auto now = std::chrono::steady_clock::now();
  std::uint64_t changes = 0;
  {
    std::lock_guard lock(mutex_);
    changes = changes_;
    if (owner_token_now_.until > now) return principal(owner_token_now_.is_script);
  }
  const auto can_sign_in = STRATA_TRY(store_.accounts().administrator_can_sign_in(local_accounts_));
  std::lock_guard lock(mutex_);
  if (changes == changes_) owner_token_now_ = {can_sign_in, now + kRememberFor};
  return principal(can_sign_in);
}

std::string Authenticator::secret_of(const Request& request) {
  const std::string authorization(request.header("authorization"));
  if (authorization.empty()) {
    const std::string cookie(request.as_kiosk ? kKioskCookie : kSessionCookie);
    std::string secret = cookie_value(request.header("cookie"), std::string(kHostPrefix) + cookie);
    // Over HTTPS, the name without the prefix is ignored because a neighboring host may have set
    // that cookie.
    if (secret.empty() && !came_by_https(request))
      secret = cookie_value(request.header("cookie"), cookie);
    return secret;
  }
  if (to_lower(authorization.substr(0, kScheme.size())) == kScheme)
    return authorization.substr(kScheme.size());
  return accepts_basic(request) ? basic_password(authorization) : std::string();
}

Result<std::optional<Principal>> Authenticator::identify(const Request& request) {
  const bool by_cookie = request.header("authorization").empty();
  const std::string secret = secret_of(request);
  if (secret.empty() && by_cookie) return std::nullopt;
  if (secret.empty())
    return fail(
        ErrorCode::unauthenticated, "Not signed in",
        "The Authorization header must have the form `Bearer TOKEN`. Under /ogc, it can also "
        "contain the token as a password (`Basic`).",
        "Authorization");
  auto principal = STRATA_TRY(identify_token(secret));
  if (!principal) return unknown_secret();
  // Each cookie is valid only for its own purpose. A script that sets cookies cannot turn a user's
  // page into a kiosk, or a kiosk into a user's page.
  const bool is_kiosk = principal->kiosk.has_value();
  if (request.as_kiosk ? !is_kiosk : by_cookie && is_kiosk) return unknown_secret();
  // A token for scripts is not accepted as a session cookie, because it does not end with the
  // browser session, and no page lists it as a session.
  const bool is_session = principal->secret != 0 && !principal->is_script;
  if (by_cookie && !is_kiosk && !is_session) return unknown_secret();
  principal->by_cookie = by_cookie;
  return principal;
}

Result<std::string> Authenticator::session_for_password(const std::string& user,
                                                        const std::string& password,
                                                        const std::string& agent) {
  const auto hash = STRATA_TRY(store_.accounts().password_of(user));
  const auto fits = STRATA_TRY(store::password_fits(hash, password));
  if (!fits)
    return fail(ErrorCode::unauthenticated, "Not signed in",
                "Wrong user name or password. Passwords are case-sensitive. If you forgot your "
                "password, ask the person who invited you for a new link.",
                "password");
  auto session = store_.tokens().create(store::TokenKind::session, user, Role::viewer,
                                        kSessionLifetime, agent, hash);
  if (!session)
    return session.error().code == ErrorCode::not_found ? unknown_secret()
                                                        : tl::unexpected(session.error());
  return std::move(session->secret);
}

Result<std::string> Authenticator::session_for_token(const std::string& token,
                                                     const std::string& agent) {
  if (token.size() > kMaxTokenLength) return unknown_secret();
  auto by_link = STRATA_TRY(store_.tokens().redeem_owner_link(token, kSessionLifetime, agent));
  if (by_link) return *by_link;
  auto principal = STRATA_TRY(identify_token(token));
  if (!principal) return unknown_secret();
  // A session or token cannot create a session, because the new session could outlive it.
  if (principal->secret != 0 || principal->is_script || principal->kiosk)
    return fail(ErrorCode::forbidden, "Cannot sign in with this token",
                "You cannot sign in with a token for scripts. Scripts send it as "
                "`Authorization: Bearer TOKEN`. In a browser, enter your user name and "
                "password.",
                "token");
  auto session = store_.tokens().create(store::TokenKind::session, principal->user, Role::owner,
                                        kSessionLifetime, agent);
  if (!session) return tl::unexpected(session.error());
  return std::move(session->secret);
}

Result<std::string> Authenticator::session_for_link(const std::string& link,
                                                    const std::string& agent) {
  auto session = STRATA_TRY(store_.tokens().redeem_owner_link(link, kSessionLifetime, agent));
  if (!session)
    return fail(ErrorCode::unauthenticated, "Link is not valid",
                "This sign-in link does not exist, has expired or was revoked. If the owner has a "
                "password, sign in with it. Otherwise, restart the server, which then prints a new "
                "link.",
                "link");
  return *session;
}

void Authenticator::forget() {
  std::lock_guard lock(mutex_);
  ++changes_;
  remembered_.clear();
  owner_token_now_ = {};
}

Result<void> Authenticator::end_session(const std::string& session_token) {
  auto ended = store_.tokens().revoke(session_token);
  forget();
  return ended;
}

std::string Authenticator::set_cookie(const std::string& session_token, bool secure) {
  return cookie_of(kSessionCookie, session_token, kSessionLifetime, secure);
}

std::string Authenticator::clear_cookie(bool secure) {
  return cookie_of(kSessionCookie, {}, std::chrono::seconds(0), secure);
}

std::string Authenticator::set_kiosk_cookie(const std::string& link, bool secure) {
  return cookie_of(kKioskCookie, link, kKioskLifetime, secure);
}

std::string Authenticator::set_sign_in_cookie(const std::string& secret, bool secure) {
  return cookie_of(kSignInCookie, secret, kSignInLifetime, secure, "Lax");
}

std::string Authenticator::clear_sign_in_cookie(bool secure) {
  return cookie_of(kSignInCookie, {}, std::chrono::seconds(0), secure, "Lax");
}

std::string Authenticator::sign_in_secret_of(const Request& request, bool secure) {
  return cookie_value(request.header("cookie"),
                      std::string(secure ? kHostPrefix : "") + std::string(kSignInCookie));
}

}  // namespace strata::net
