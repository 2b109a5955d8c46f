#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/error.h"
#include "sign_on/key_set.h"

namespace strata::sign_on {

inline constexpr std::size_t kMaxIdToken = 64u << 10;  // bytes
inline constexpr std::chrono::seconds kClockSkew{60};

// The parts of the header that select the key.
struct TokenHeader {
  Algorithm algorithm = Algorithm::rs256;
  std::string kid;  // empty if the token names no key
};

// The values that an ID token must contain.
struct ExpectedToken {
  std::string issuer, client_id, nonce;
  std::chrono::system_clock::time_point now;
};

// Reads the header of a signed JWT (RFC 7519). Returns an `unauthenticated` error for another
// format, for algorithms other than RS256 and ES256, and for critical extensions.
Result<TokenHeader> read_token_header(std::string_view token);

// Checks the signature and the claims of an ID token (OpenID Connect Core 1.0, 3.1.3.7) and returns
// the claims. The claim `sub` of the result is a text of 1 to 255 bytes. Returns an
// `unauthenticated` error if the token is not valid.
Result<nlohmann::json> verify_id_token(std::string_view token, const KeySet& keys,
                                       const ExpectedToken& expected);

}  // namespace strata::sign_on
