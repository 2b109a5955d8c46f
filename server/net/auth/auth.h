#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "core/ids.h"
#include "net/http/http_types.h"
#include "store/store.h"

namespace strata::net {

// With HTTPS, the cookie names get the prefix `__Host-`. Browsers then accept these cookies only
// from this host, over HTTPS and for all paths (RFC 6265bis).
constexpr std::string_view kSessionCookie = "strata_session", kKioskCookie = "strata_kiosk";
// Identifies the browser during a sign-in with OpenID Connect.
constexpr std::string_view kSignInCookie = "strata_sign_in";
constexpr std::chrono::minutes kSignInLifetime{10};
constexpr std::chrono::hours kSessionLifetime{24 * 90};
// The lifetime of the cookie. The link has its own expiry date.
constexpr std::chrono::hours kKioskLifetime{24 * 365};
constexpr std::size_t kMinOwnerTokenLength = 32;

// Returns the name of a kiosk in lists of users. A user name cannot contain blanks, so it never
// equals the name of a kiosk.
std::string kiosk_name(KioskId id);
bool is_kiosk_name(const std::string& user);

// Identifies the sender of a request by a bearer token or by the session cookie. A request that is
// marked as coming from a kiosk is identified by the kiosk cookie instead. Thread-safe. May query
// the database, so call it on a worker. Caches results for a few seconds, so a busy page does not
// need a query for each request.
class Authenticator {
 public:
  // `owner_token` is the value of STRATA_OWNER_TOKEN and may be empty. The token has the owner role
  // until an administrator can sign in. Afterwards it is a token for scripts with the administrator
  // role. `local_accounts`: people can sign in with passwords.
  Authenticator(store::Store& store, std::string owner_token, bool local_accounts);

  // Returns nothing if the request has no secret. Returns 401 if the secret is unknown, expired or
  // revoked, and 503 if the database is unreachable.
  Result<std::optional<Principal>> identify(const Request& request);
  Result<std::optional<Principal>> identify_token(const std::string& token);
  // Returns the bearer token or, if it is absent, the applicable cookie. Returns an empty text if
  // the request has neither.
  static std::string secret_of(const Request& request);

  // Create a browser session and return its secret. The credential is a password, a token or a
  // link. The token must be the secret of an owner link, or the owner's token with the owner role.
  // `agent` is the browser's User-Agent. Return 401 for wrong credentials and 403 for a token for
  // scripts.
  Result<std::string> session_for_password(const std::string& user, const std::string& password,
                                           const std::string& agent);
  Result<std::string> session_for_token(const std::string& token, const std::string& agent);
  Result<std::string> session_for_link(const std::string& link, const std::string& agent);
  Result<void> end_session(const std::string& session_token);
  // Clears the cache. Call it after a change to accounts or tokens.
  void forget();

  static std::string set_cookie(const std::string& session_token, bool secure);
  static std::string clear_cookie(bool secure);
  static std::string set_kiosk_cookie(const std::string& link, bool secure);
  // The cookie of a sign-in. The browser sends it when the provider redirects to this server.
  static std::string set_sign_in_cookie(const std::string& secret, bool secure);
  static std::string clear_sign_in_cookie(bool secure);
  static std::string sign_in_secret_of(const Request& request, bool secure);

 private:
  Result<Principal> owner_by_token();

  struct Remembered {
    Principal principal;
    std::chrono::steady_clock::time_point until;
  };
  store::Store& store_;
  const std::string owner_token_;
  const bool local_accounts_;
  std::mutex mutex_;
  std::unordered_map<std::string, Remembered> remembered_;
  std::uint64_t changes_ = 0;  // the number of calls to `forget`
  struct {
    bool is_script = false;
    std::chrono::steady_clock::time_point until;
  } owner_token_now_;  // cached in the same way as `remembered_`
};

}  // namespace strata::net
