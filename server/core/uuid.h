#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace strata {

// The identifier of a message that changes data, or of a session (RFC 4122).
struct Uuid {
  std::array<std::uint8_t, 16> bytes{};
  auto operator<=>(const Uuid&) const = default;
};

Uuid random_uuid();
std::optional<Uuid> parse_uuid(std::string_view text);  // canonical 36 characters only
std::string to_string(const Uuid& uuid);

}  // namespace strata

template <>
struct std::hash<strata::Uuid> {
  std::size_t operator()(const strata::Uuid& u) const noexcept {
    std::size_t h = 1469598103934665603ULL;
    for (auto b : u.bytes) h = (h ^ b) * 1099511628211ULL;
    return h;
  }
};
