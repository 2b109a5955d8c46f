#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/uuid.h"

namespace strata {

using Sha256 = std::array<std::uint8_t, 32>;

class Sha256Stream {
 public:
  Sha256Stream();
  ~Sha256Stream();
  void add(std::span<const std::uint8_t> bytes);
  Sha256 finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

Sha256 sha256(std::span<const std::uint8_t> bytes);
Sha256 sha256(std::string_view text);
std::string sha256_hex(std::string_view text);

// Returns a UUID (version 8, from a SHA-256 hash) that depends only on the text. Used to convert an
// Idempotency-Key to the id of an edit.
Uuid uuid_of_text(std::string_view text);

}  // namespace strata
