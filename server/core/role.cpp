#include "core/role.h"

#include <array>

namespace strata {
namespace {
constexpr std::array<std::string_view, 5> kNames{"viewer", "annotator", "curator", "administrator", "owner"};
}

std::optional<Role> parse_role(std::string_view text) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == text) return static_cast<Role>(i);
  return std::nullopt;
}

std::string_view name(Role role) { return kNames[static_cast<std::size_t>(role)]; }

}  // namespace strata
