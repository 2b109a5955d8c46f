#pragma once

#include <optional>
#include <string_view>

namespace strata {

// Ascending: each may do what the ones before may.
enum class Role { viewer, annotator, curator, administrator, owner };
std::optional<Role> parse_role(std::string_view name);
std::string_view name(Role role);

}  // namespace strata
