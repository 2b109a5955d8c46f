#include "core/secret.h"

#include <sodium.h>

#include <array>

#include "core/digest.h"
#include "core/text/base64.h"

namespace strata {

std::string random_token() {
  std::array<std::uint8_t, 32> secret{};
  randombytes_buf(secret.data(), secret.size());
  return to_base64url(secret);
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  // Compares hashes, so the running time reveals neither the lengths nor where the texts differ.
  const Sha256 hash_a = sha256(a), hash_b = sha256(b);
  return sodium_memcmp(hash_a.data(), hash_b.data(), hash_a.size()) == 0;
}

}  // namespace strata
