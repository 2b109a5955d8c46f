#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/ids.h"

namespace strata {

// In ascending order. Each role includes the rights of the previous roles. A guest sees no project.
enum class Role { guest, viewer, annotator, curator, administrator, owner };
std::optional<Role> parse_role(std::string_view name);
std::string_view name(Role role);

// The author of a request or change. The name and role have no defaults, so callers must state
// both.
struct Author {
  Author(std::string name, Role may) : user(std::move(name)), role(may) {}
  std::string user;
  Role role;
};

// A user's roles.
struct Roles {
  Role everywhere = Role::guest;
  std::map<ProjectId, Role> in_projects{};  // by the project's id

  Role in(ProjectId project) const;  // returns the higher of the two roles
  Role highest() const;
  Roles at_most(Role role) const;
  bool operator==(const Roles&) const = default;
};

}  // namespace strata
