#include "support/signed_tokens.h"

#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/ec.h>
#include <openssl/ecdsa.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/pem.h>
#include <openssl/rsa.h>

#include <array>
#include <vector>

#include "core/text/base64.h"
#include "core/text/bytes.h"

namespace strata::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes number_in(EVP_PKEY* key, const char* name, int size = 0) {
  BIGNUM* number = nullptr;
  EVP_PKEY_get_bn_param(key, name, &number);
  Bytes bytes(static_cast<std::size_t>(size > 0 ? size : BN_num_bytes(number)));
  BN_bn2binpad(number, bytes.data(), static_cast<int>(bytes.size()));
  BN_free(number);
  return bytes;
}

Bytes signature_of(EVP_PKEY* key, std::string_view text) {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  EVP_DigestSignInit(context, nullptr, EVP_sha256(), nullptr, key);
  const auto bytes = bytes_of(text);
  std::size_t size = 0;
  EVP_DigestSign(context, nullptr, &size, bytes.data(), bytes.size());
  Bytes signature(size);
  EVP_DigestSign(context, signature.data(), &size, bytes.data(), bytes.size());
  signature.resize(size);
  EVP_MD_CTX_free(context);
  return signature;
}

// The two numbers of the signature, 32 bytes each.
Bytes plain_signature(const Bytes& der) {
  const std::uint8_t* begin = der.data();
  ECDSA_SIG* both = d2i_ECDSA_SIG(nullptr, &begin, static_cast<long>(der.size()));
  Bytes plain(64);
  BN_bn2binpad(ECDSA_SIG_get0_r(both), plain.data(), 32);
  BN_bn2binpad(ECDSA_SIG_get0_s(both), plain.data() + 32, 32);
  ECDSA_SIG_free(both);
  return plain;
}

std::string unsigned_text(const nlohmann::json& header, const nlohmann::json& claims) {
  return base64url_of(header.dump()) + "." + base64url_of(claims.dump());
}

}  // namespace

std::string base64url_of(std::string_view text) { return to_base64url(bytes_of(text)); }

TokenKey::TokenKey(std::string kid, EVP_PKEY* key, bool is_rsa)
    : kid_(std::move(kid)), key_(key, EVP_PKEY_free), is_rsa_(is_rsa) {}

TokenKey TokenKey::rsa(std::string kid, int bits) {
  return {std::move(kid), EVP_RSA_gen(static_cast<unsigned>(bits)), true};
}

TokenKey TokenKey::p256(std::string kid) { return {std::move(kid), EVP_EC_gen("P-256"), false}; }

nlohmann::json TokenKey::public_jwk() const {
  EVP_PKEY* key = key_.get();
  if (is_rsa_)
    return {{"kty", "RSA"},
            {"kid", kid_},
            {"use", "sig"},
            {"alg", "RS256"},
            {"n", to_base64url(number_in(key, OSSL_PKEY_PARAM_RSA_N))},
            {"e", to_base64url(number_in(key, OSSL_PKEY_PARAM_RSA_E))}};
  return {{"kty", "EC"},
          {"kid", kid_},
          {"use", "sig"},
          {"crv", "P-256"},
          {"x", to_base64url(number_in(key, OSSL_PKEY_PARAM_EC_PUB_X, 32))},
          {"y", to_base64url(number_in(key, OSSL_PKEY_PARAM_EC_PUB_Y, 32))}};
}

std::string TokenKey::public_pem() const {
  BIO* memory = BIO_new(BIO_s_mem());
  PEM_write_bio_PUBKEY(memory, key_.get());
  char* text = nullptr;
  const long size = BIO_get_mem_data(memory, &text);
  std::string pem(text, static_cast<std::size_t>(size));
  BIO_free(memory);
  return pem;
}

std::string TokenKey::sign(const nlohmann::json& header, const nlohmann::json& claims) const {
  const std::string text = unsigned_text(header, claims);
  const Bytes signature = signature_of(key_.get(), text);
  return text + "." + to_base64url(is_rsa_ ? signature : plain_signature(signature));
}

std::string TokenKey::sign(const nlohmann::json& claims) const {
  return sign({{"alg", is_rsa_ ? "RS256" : "ES256"}, {"typ", "JWT"}, {"kid", kid_}}, claims);
}

std::string sign_hs256(const nlohmann::json& header, const nlohmann::json& claims,
                       const std::string& secret) {
  const std::string text = unsigned_text(header, claims);
  std::array<std::uint8_t, 32> mac{};
  unsigned size = 0;
  HMAC(EVP_sha256(), secret.data(), static_cast<int>(secret.size()), bytes_of(text).data(),
       text.size(), mac.data(), &size);
  return text + "." + to_base64url(mac);
}

}  // namespace strata::test
