#include "core/digest.h"

#include <openssl/evp.h>

#include <algorithm>

#include "core/text/bytes.h"
#include "core/text/hex.h"

namespace strata {

struct Sha256Stream::Impl {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  ~Impl() { EVP_MD_CTX_free(context); }
};

Sha256Stream::Sha256Stream() : impl_(std::make_unique<Impl>()) {
  EVP_DigestInit_ex(impl_->context, EVP_sha256(), nullptr);
}
Sha256Stream::~Sha256Stream() = default;

void Sha256Stream::add(std::span<const std::uint8_t> bytes) {
  EVP_DigestUpdate(impl_->context, bytes.data(), bytes.size());
}

Sha256 Sha256Stream::finish() {
  Sha256 hash{};
  EVP_DigestFinal_ex(impl_->context, hash.data(), nullptr);
  return hash;
}

Sha256 sha256(std::span<const std::uint8_t> bytes) {
  Sha256Stream stream;
  stream.add(bytes);
  return stream.finish();
}

Sha256 sha256(std::string_view text) { return sha256(bytes_of(text)); }

std::string sha256_hex(std::string_view text) { return to_hex(sha256(text)); }

Uuid uuid_of_text(std::string_view text) {
  const Sha256 hash = sha256(text);
  Uuid uuid;
  std::copy_n(hash.begin(), uuid.bytes.size(), uuid.bytes.begin());
  uuid.bytes[6] = static_cast<std::uint8_t>((uuid.bytes[6] & 0x0f) | 0x80);
  uuid.bytes[8] = static_cast<std::uint8_t>((uuid.bytes[8] & 0x3f) | 0x80);
  return uuid;
}

}  // namespace strata
