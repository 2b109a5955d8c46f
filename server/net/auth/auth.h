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

// Over https the names begin with `__Host-`: browsers then accept the cookies from this host only,
// over https, for all paths (RFC 6265bis).
constexpr std::string_view kSessionCookie = "strata_session", kKioskCookie = "strata_kiosk";
constexpr std::chrono::hours kSessionLifetime{24 * 90};
// of the cookie; the link has its own expiry
constexpr std::chrono::hours kKioskLifetime{24 * 365};
constexpr std::size_t kMinOwnerTokenLength = 32;

// The name of a kiosk in lists of people. User names contain no blanks.
std::string kiosk_name(KioskId id);
bool is_kiosk_name(const std::string& user);

// Identifies the sender of a request: by bearer token, by the session cookie, or, if the request is
// marked as a kiosk's, by the kiosk's cookie. Thread-safe; may query the database, so call it on a
// worker. Results are cached for a few seconds, so that a busy page needs no query per request.
class Authenticator {
 public:
  // `owner_token`, if not empty (STRATA_OWNER_TOKEN), has the owner's role until an administrator
  // has a password; afterwards it is an administrator's token for scripts.
  Authenticator(store::Store& store, std::string owner_token);

  // Nothing: the request has no secret. 401: the secret is unknown, expired or revoked. 503: the
  // database is unreachable.
  Result<std::optional<Principal>> identify(const Request& request);
  Result<std::optional<Principal>> identify_token(const std::string& token);
  // The bearer token, otherwise the applicable cookie; empty if the request has neither.
  static std::string secret_of(const Request& request);

  // Make a browser session from a password, a token (the owner's token while it acts as the owner,
  // or the secret of an owner link) or a link, and return the session's secret. `agent`: the
  // browser's User-Agent. 401: wrong credentials. 403: a token for scripts.
  Result<std::string> session_for_password(const std::string& user, const std::string& password,
                                           const std::string& agent);
  Result<std::string> session_for_token(const std::string& token, const std::string& agent);
  Result<std::string> session_for_link(const std::string& link, const std::string& agent);
  Result<void> end_session(const std::string& session_token);
  // Clears the cache. Call after a change of accounts or tokens.
  void forget();

  static std::string set_cookie(const std::string& session_token, bool secure);
  static std::string clear_cookie(bool secure);
  static std::string set_kiosk_cookie(const std::string& link, bool secure);

 private:
  Result<Principal> owner_by_token();

  struct Remembered {
    Principal principal;
    std::chrono::steady_clock::time_point until;
  };
  store::Store& store_;
  const std::string owner_token_;
  std::mutex mutex_;
  std::unordered_map<std::string, Remembered> remembered_;
  std::uint64_t changes_ = 0;  // number of calls of `forget`
  struct {
    bool is_script = false;
    std::chrono::steady_clock::time_point until;
  } owner_token_now_;  // cached as `remembered_`
};

}  // namespace strata::net
