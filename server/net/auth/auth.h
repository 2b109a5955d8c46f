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

// By https their names begin with `__Host-`: browsers then take them from this host alone, by
// https, for all paths (RFC 6265bis).
constexpr std::string_view kSessionCookie = "strata_session", kKioskCookie = "strata_kiosk";
constexpr std::chrono::hours kSessionLifetime{24 * 90};
// of the cookie; the link says for itself how long it is good
constexpr std::chrono::hours kKioskLifetime{24 * 365};
constexpr std::size_t kMinOwnerTokenLength = 32;

// What a kiosk is called among people, whose names have no blanks.
std::string kiosk_name(KioskId id);
bool is_kiosk_name(const std::string& user);

// Tells who sends a request: by bearer token, or by the session cookie, or, where the request is
// marked so, by that of a kiosk. Thread-safe; may ask the database, so call it on a worker. Answers
// are remembered for a few seconds so that a busy page costs no query a request.
class Authenticator {
 public:
  // `owner_token`, when it is not empty (STRATA_OWNER_TOKEN), acts as the owner until an
  // administrator has a password, and from then on as an administrator's token for scripts.
  Authenticator(store::Store& store, std::string owner_token);

  // Empty: no secret was sent. 401: one was sent that is unknown, expired or revoked. 503: the
  // database is away.
  Result<std::optional<Principal>> identify(const Request& request);
  Result<std::optional<Principal>> identify_token(const std::string& token);
  // What the request shows: a bearer token, else the cookie that counts for it; empty when neither.
  static std::string secret_of(const Request& request);

  // The secret of a new browser session for who knows the password, holds the token (the owner's
  // while it acts as the owner, or the secret of an owner link) or the link. `agent`: what the
  // browser calls itself. 401: they do not fit. 403: a token for scripts.
  Result<std::string> session_for_password(const std::string& user, const std::string& password,
                                           const std::string& agent);
  Result<std::string> session_for_token(const std::string& token, const std::string& agent);
  Result<std::string> session_for_link(const std::string& link, const std::string& agent);
  Result<void> end_session(const std::string& session_token);
  // What is remembered of anybody; for when accounts or tokens changed.
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
  std::uint64_t changes_ = 0;  // `forget`s so far
  struct {
    bool is_script = false;
    std::chrono::steady_clock::time_point until;
  } owner_token_now_;  // as `remembered_`
};

}  // namespace strata::net
