#include "sign_on/key_set.h"

#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/ec.h>
#include <openssl/ecdsa.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/param_build.h>

#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/text/base64.h"
#include "core/text/bytes.h"

namespace strata::sign_on {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr int kMinRsaBits = 2048, kMaxRsaBits = 8192;
constexpr std::size_t kMaxExponent = 8, kCoordinate = 32;

template <auto Free>
struct Deleter {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
using Number = std::unique_ptr<BIGNUM, Deleter<BN_free>>;
using Builder = std::unique_ptr<OSSL_PARAM_BLD, Deleter<OSSL_PARAM_BLD_free>>;
using Parameters = std::unique_ptr<OSSL_PARAM, Deleter<OSSL_PARAM_free>>;
using Context = std::unique_ptr<EVP_PKEY_CTX, Deleter<EVP_PKEY_CTX_free>>;
using Digest = std::unique_ptr<EVP_MD_CTX, Deleter<EVP_MD_CTX_free>>;
using Signature = std::unique_ptr<ECDSA_SIG, Deleter<ECDSA_SIG_free>>;

std::string text_of(const nlohmann::json& object, const char* member) {
  const auto found = object.find(member);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Bytes bytes_in(const nlohmann::json& object, const char* member) {
  return from_base64(text_of(object, member)).value_or(Bytes());
}

Number number_of(std::span<const std::uint8_t> bytes) {
  return Number(BN_bin2bn(bytes.data(), static_cast<int>(bytes.size()), nullptr));
}

std::shared_ptr<EVP_PKEY> make_key(const char* kind, OSSL_PARAM_BLD* builder) {
  const Parameters parameters(OSSL_PARAM_BLD_to_param(builder));
  const Context context(EVP_PKEY_CTX_new_from_name(nullptr, kind, nullptr));
  EVP_PKEY* key = nullptr;
  if (!parameters || !context || EVP_PKEY_fromdata_init(context.get()) <= 0 ||
      EVP_PKEY_fromdata(context.get(), &key, EVP_PKEY_PUBLIC_KEY, parameters.get()) <= 0)
    return nullptr;
  return {key, EVP_PKEY_free};
}

std::shared_ptr<EVP_PKEY> rsa_key(const nlohmann::json& json) {
  const Bytes modulus = bytes_in(json, "n"), exponent = bytes_in(json, "e");
  if (modulus.empty() || modulus.size() > kMaxRsaBits / 8 || exponent.empty() ||
      exponent.size() > kMaxExponent || exponent.back() % 2 == 0 ||
      (exponent.size() == 1 && exponent.front() == 1))
    return nullptr;
  const Number n = number_of(modulus), e = number_of(exponent);
  const Builder builder(OSSL_PARAM_BLD_new());
  if (!n || !e || !builder ||
      !OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_N, n.get()) ||
      !OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_E, e.get()))
    return nullptr;
  auto key = make_key("RSA", builder.get());
  const int bits = key ? EVP_PKEY_get_bits(key.get()) : 0;
  return bits >= kMinRsaBits && bits <= kMaxRsaBits ? key : nullptr;
}

std::shared_ptr<EVP_PKEY> p256_key(const nlohmann::json& json) {
  const Bytes x = bytes_in(json, "x"), y = bytes_in(json, "y");
  if (text_of(json, "crv") != "P-256" || x.size() != kCoordinate || y.size() != kCoordinate)
    return nullptr;
  Bytes point{POINT_CONVERSION_UNCOMPRESSED};
  point.insert(point.end(), x.begin(), x.end());
  point.insert(point.end(), y.begin(), y.end());
  const Builder builder(OSSL_PARAM_BLD_new());
  if (!builder ||
      !OSSL_PARAM_BLD_push_utf8_string(builder.get(), OSSL_PKEY_PARAM_GROUP_NAME, "prime256v1",
                                       0) ||
      !OSSL_PARAM_BLD_push_octet_string(builder.get(), OSSL_PKEY_PARAM_PUB_KEY, point.data(),
                                        point.size()))
    return nullptr;
  return make_key("EC", builder.get());
}

// Converts the two numbers of a JWS signature (RFC 7518, 3.4) to the form that OpenSSL reads.
std::optional<Bytes> der_signature(std::span<const std::uint8_t> signature) {
  if (signature.size() != 2 * kCoordinate) return std::nullopt;
  Number r = number_of(signature.first(kCoordinate)), s = number_of(signature.last(kCoordinate));
  const Signature both(ECDSA_SIG_new());
  if (!r || !s || !both || !ECDSA_SIG_set0(both.get(), r.get(), s.get())) return std::nullopt;
  (void)r.release();
  (void)s.release();
  std::array<std::uint8_t, 128> der{};
  if (i2d_ECDSA_SIG(both.get(), nullptr) > static_cast<int>(der.size())) return std::nullopt;
  std::uint8_t* end = der.data();
  const int size = i2d_ECDSA_SIG(both.get(), &end);
  if (size <= 0) return std::nullopt;
  return Bytes(der.begin(), der.begin() + size);
}

bool is_signed_by(EVP_PKEY* key, std::string_view text, std::span<const std::uint8_t> signature) {
  const Digest digest(EVP_MD_CTX_new());
  const auto bytes = bytes_of(text);
  const bool verified =
      digest && EVP_DigestVerifyInit(digest.get(), nullptr, EVP_sha256(), nullptr, key) == 1 &&
      EVP_DigestVerify(digest.get(), signature.data(), signature.size(), bytes.data(),
                       bytes.size()) == 1;
  ERR_clear_error();
  return verified;
}

}  // namespace

Result<KeySet> KeySet::parse(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto list = json.is_object() ? json.find("keys") : json.end();
  if (!json.is_object() || list == json.end() || !list->is_array() || list->size() > kMaxKeys)
    return fail(ErrorCode::bad_gateway, "Invalid keys",
                "The provider did not return a set of at most 64 keys.");
  KeySet set;
  for (const auto& each : *list) {
    if (!each.is_object() || (each.contains("use") && text_of(each, "use") != "sig")) continue;
    const std::string kind = text_of(each, "kty"), of = text_of(each, "alg");
    Key key;
    key.kid = text_of(each, "kid");
    if (kind == "RSA" && (of.empty() || of == "RS256")) {
      key.algorithm = Algorithm::rs256;
      key.key = rsa_key(each);
    } else if (kind == "EC" && (of.empty() || of == "ES256")) {
      key.algorithm = Algorithm::es256;
      key.key = p256_key(each);
    }
    ERR_clear_error();
    if (key.key) set.keys_.push_back(std::move(key));
  }
  return set;
}

std::vector<const KeySet::Key*> KeySet::find(Algorithm algorithm, const std::string& kid) const {
  std::vector<const Key*> found;
  for (const Key& key : keys_)
    if (key.algorithm == algorithm && (kid.empty() || key.kid == kid)) found.push_back(&key);
  return found;
}

bool KeySet::has(Algorithm algorithm, const std::string& kid) const {
  return find(algorithm, kid).size() == 1;
}

bool KeySet::verifies(Algorithm algorithm, const std::string& kid, std::string_view text,
                      std::span<const std::uint8_t> signature) const {
  const auto found = find(algorithm, kid);
  if (found.size() != 1) return false;
  if (algorithm == Algorithm::rs256) return is_signed_by(found.front()->key.get(), text, signature);
  const auto der = der_signature(signature);
  return der && is_signed_by(found.front()->key.get(), text, *der);
}

}  // namespace strata::sign_on
