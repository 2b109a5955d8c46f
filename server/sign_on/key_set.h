#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

using EVP_PKEY = struct evp_pkey_st;  // of OpenSSL

namespace strata::sign_on {

enum class Algorithm { rs256, es256 };

// The public keys of a provider (RFC 7517) for signatures: RSA keys of 2048 to 8192 bits and keys
// on the curve P-256. Other keys are ignored.
class KeySet {
 public:
  static constexpr std::size_t kMaxKeys = 64;

  KeySet() = default;
  // Returns a `bad_gateway` error if the text is not a set of keys.
  static Result<KeySet> parse(std::string_view text);

  std::size_t size() const { return keys_.size(); }
  // Returns whether there is a key for a token. A token without a `kid` needs a set with one key
  // for the algorithm.
  bool has(Algorithm algorithm, const std::string& kid) const;
  // Returns whether a key of the set made the signature of the text.
  bool verifies(Algorithm algorithm, const std::string& kid, std::string_view text,
                std::span<const std::uint8_t> signature) const;

 private:
  struct Key {
    std::string kid;
    Algorithm algorithm = Algorithm::rs256;
    std::shared_ptr<EVP_PKEY> key;
  };
  std::vector<const Key*> find(Algorithm algorithm, const std::string& kid) const;

  std::vector<Key> keys_;
};

}  // namespace strata::sign_on
