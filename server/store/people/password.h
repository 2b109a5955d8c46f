#pragma once

#include <string>
#include <string_view>

#include "core/error.h"

namespace strata::store {

inline constexpr std::size_t kMinPasswordLength = 10,
                             kMaxPasswordLength = 1024;  // characters; bytes

// Whether a person may choose it (invalid at `field`): long enough, and not the name. No other
// rules: they make passwords worse (NIST SP 800-63B, 5.1.1.2).
Result<void> check_password(std::string_view password, std::string_view user,
                            const std::string& field);

// Argon2id (RFC 9106) by libsodium, with 64 MiB and two passes: some 60 ms of a core. The text
// holds salt and costs. Two at once are worked on; too_many_requests: too many wait already.
Result<std::string> hash_password(std::string_view password);
// As slow as a look into a real hash, also where `hash` is empty: nobody learns from the time which
// names there are.
Result<bool> password_fits(const std::string& hash, std::string_view password);

}  // namespace strata::store
