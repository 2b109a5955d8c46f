#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace strata {

// Ascending: each may do what the ones before may.
enum class Role { viewer, annotator, curator, administrator, owner };
std::optional<Role> parse_role(std::string_view name);
std::string_view name(Role role);

// Who changes something. Neither part has a default, so that whoever makes a change says both.
struct Author {
  Author(std::string name, Role may) : user(std::move(name)), role(may) {}
  std::string user;
  Role role;
};

}  // namespace strata
