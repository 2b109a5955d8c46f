#pragma once

#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/error.h"
#include "sign_on/config.h"
#include "sign_on/fetch.h"
#include "sign_on/key_set.h"

namespace strata::sign_on {

// The secrets of one sign-in. The provider gets the state, the nonce and a hash of the verifier.
struct Handshake {
  std::string state, nonce, code_verifier;
  static Handshake make();  // random
};

// The response of a provider to the browser.
struct Callback {
  std::string code;
  std::optional<std::string> issuer;  // the parameter `iss` (RFC 9207)
};

// Signs people in at one provider (OpenID Connect Core 1.0, authorization code flow with PKCE,
// RFC 7636). Remembers the discovery document and the keys of the provider for an hour.
// Thread-safe. All functions may send requests and block, so call them on a worker. Errors are
// `bad_gateway` if the provider does not work, and `unauthenticated` if it refused the sign-in or
// if its token is not valid.
class Client {
 public:
  using Clock = std::function<std::chrono::system_clock::time_point()>;

  explicit Client(Provider provider, Fetch fetch = &sign_on::fetch,
                  Clock clock = &std::chrono::system_clock::now);

  const Provider& provider() const { return provider_; }

  // Returns the address at the provider that the browser opens.
  Result<std::string> authorization_url(const std::string& redirect_uri,
                                        const Handshake& handshake);
  // Exchanges the code for an ID token, checks the token, and returns the claims of the person.
  Result<nlohmann::json> claims(const Callback& callback, const std::string& redirect_uri,
                                const Handshake& handshake);

 private:
  using Time = std::chrono::system_clock::time_point;
  struct Endpoints {
    std::string authorization, token, keys, userinfo;
    bool secret_in_form = false;  // the provider does not support HTTP Basic
    bool sends_issuer = false;    // each response must have the parameter `iss`
  };

  // The functions with a lock expect that `mutex_` is locked.
  Result<Endpoints> endpoints();
  Result<Endpoints> load_endpoints_locked() const;
  Result<KeySet> keys_for(const std::string& token, const std::string& address);
  Result<nlohmann::json> exchange(const Endpoints& endpoints, const std::string& code,
                                  const std::string& redirect_uri,
                                  const std::string& code_verifier) const;
  Result<void> add_userinfo(const Endpoints& endpoints, const nlohmann::json& reply,
                            nlohmann::json& claims) const;

  const Provider provider_;
  const Fetch fetch_;
  const Clock clock_;

  std::mutex mutex_;
  std::optional<Endpoints> endpoints_;
  Time endpoints_until_{};
  std::optional<Error> failure_;  // of the last attempt to load the discovery document
  KeySet keys_;
  Time keys_loaded_{};
  std::optional<Error> keys_failure_;  // of the last attempt to load the keys
};

}  // namespace strata::sign_on
