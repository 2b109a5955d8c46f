#pragma once

#include <string>
#include <string_view>

#include "core/error.h"

namespace strata::store {

inline constexpr std::size_t kMinPasswordLength = 10,
                             kMaxPasswordLength = 1024;  // limits in characters, and in bytes

// Checks whether a user may choose the password, and returns an `invalid` error at `field` if not.
// The password must be long enough and differ from the name. There are no other rules, because they
// make passwords worse (NIST SP 800-63B, 5.1.1.2).
Result<void> check_password(std::string_view password, std::string_view user,
                            const std::string& field);

// Hashes the password with Argon2id (RFC 9106) from libsodium, with 64 MiB and two passes, in about
// 60 ms on one core. The result contains the salt and the cost parameters. Computes at most two
// hashes at a time. Returns a `too_many_requests` error if too many calls are waiting.
Result<std::string> hash_password(std::string_view password);
// Returns true if the password matches the hash. Takes the same time for an empty `hash`, so that
// the time does not reveal which names exist.
Result<bool> password_fits(const std::string& hash, std::string_view password);

}  // namespace strata::store
