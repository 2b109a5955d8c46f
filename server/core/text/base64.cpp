#include "core/text/base64.h"

#include <sodium.h>

#include <algorithm>

namespace strata {
namespace {

std::string encoded(std::span<const std::uint8_t> bytes, int variant) {
  std::string text(sodium_base64_encoded_len(bytes.size(), variant), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), variant);
  text.pop_back();  // the terminating NUL
  return text;
}

// Sodium requires that the unused bits of the last character are zero.
void clear_bits_left_over(std::string& text) {
  static constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  const std::size_t bits = text.size() % 4 == 2 ? 4 : text.size() % 4 == 3 ? 2 : 0;
  if (const auto value = kAlphabet.find(text.empty() ? '\0' : text.back());
      value != std::string_view::npos)
    text.back() = kAlphabet[value >> bits << bits];
}

}  // namespace

std::string to_base64(std::span<const std::uint8_t> bytes) {
  return encoded(bytes, sodium_base64_VARIANT_ORIGINAL);
}

std::string to_base64url(std::span<const std::uint8_t> bytes) {
  return encoded(bytes, sodium_base64_VARIANT_URLSAFE_NO_PADDING);
}

std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text) {
  std::string digits(text.substr(0, text.find_last_not_of('=') + 1));
  std::ranges::replace(digits, '+', '-');
  std::ranges::replace(digits, '/', '_');
  clear_bits_left_over(digits);
  std::vector<std::uint8_t> bytes(digits.size() / 4 * 3 + 3);
  std::size_t size = 0;
  if (sodium_base642bin(bytes.data(), bytes.size(), digits.data(), digits.size(), nullptr, &size,
                        nullptr, sodium_base64_VARIANT_URLSAFE_NO_PADDING) != 0)
    return std::nullopt;
  bytes.resize(size);
  return bytes;
}

}  // namespace strata
