#include "core/uuid.h"

#include <algorithm>
#include <boost/uuid/random_generator.hpp>
#include <boost/uuid/uuid.hpp>
#include <boost/uuid/uuid_io.hpp>

#include "core/text/hex.h"

namespace strata {

Uuid random_uuid() {
  thread_local boost::uuids::random_generator generate;  // reads system entropy on each call
  Uuid uuid;
  std::ranges::copy(generate(), uuid.bytes.begin());
  return uuid;
}

std::optional<Uuid> parse_uuid(std::string_view text) {
  // Boost's parser also accepts other forms, and throws exceptions.
  if (text.size() != 36) return std::nullopt;
  Uuid uuid;
  for (std::size_t i = 0, at = 0; i < uuid.bytes.size(); ++i, at += 2) {
    if (i == 4 || i == 6 || i == 8 || i == 10)
      if (text[at++] != '-') return std::nullopt;
    const int high = hex_digit_value(text[at]), low = hex_digit_value(text[at + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    uuid.bytes[i] = static_cast<std::uint8_t>(high << 4 | low);
  }
  return uuid;
}

std::string to_string(const Uuid& uuid) {
  boost::uuids::uuid same;
  std::ranges::copy(uuid.bytes, same.begin());
  return boost::uuids::to_string(same);
}

}  // namespace strata
