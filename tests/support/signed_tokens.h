#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

using EVP_PKEY = struct evp_pkey_st;  // of OpenSSL

namespace strata::test {

// A key pair of a provider, which signs tokens as a provider does.
class TokenKey {
 public:
  static TokenKey rsa(std::string kid, int bits = 2048);
  static TokenKey p256(std::string kid);

  const std::string& kid() const { return kid_; }
  nlohmann::json public_jwk() const;
  std::string public_pem() const;
  // Signs header.payload. Does not change the header, which can name another algorithm.
  std::string sign(const nlohmann::json& header, const nlohmann::json& claims) const;
  // Signs with the algorithm and the name of this key.
  std::string sign(const nlohmann::json& claims) const;

 private:
  TokenKey(std::string kid, EVP_PKEY* key, bool is_rsa);
  std::string kid_;
  std::shared_ptr<EVP_PKEY> key_;
  bool is_rsa_;
};

std::string base64url_of(std::string_view text);
// Signs with HMAC-SHA-256, as HS256 does.
std::string sign_hs256(const nlohmann::json& header, const nlohmann::json& claims,
                       const std::string& secret);

}  // namespace strata::test
