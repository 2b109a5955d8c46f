#pragma once

#include <string>
#include <string_view>

#include "core/error.h"

namespace strata::store {

inline constexpr std::size_t kMinPasswordLength = 10,
                             kMaxPasswordLength = 1024;  // characters; bytes

// Checks whether a user may choose the password (invalid at `field`): it must be long enough and
// differ from the name. There are no other rules: they make passwords worse (NIST SP 800-63B,
// 5.1.1.2).
Result<void> check_password(std::string_view password, std::string_view user,
                            const std::string& field);

// Argon2id (RFC 9106) by libsodium, with 64 MiB and two passes: some 60 ms of a core. The text
// holds salt and costs. Two hashes are computed at a time; too_many_requests: too many calls wait
// already.
Result<std::string> hash_password(std::string_view password);
// Takes as long for an empty `hash` as for a real one, so that the time does not reveal which names
// exist.
Result<bool> password_fits(const std::string& hash, std::string_view password);

}  // namespace strata::store
