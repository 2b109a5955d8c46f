#include "domain/people/role.h"

#include <algorithm>
#include <array>

namespace strata {
namespace {
constexpr std::array<std::string_view, 6> kNames{"guest",   "viewer",        "annotator",
                                                 "curator", "administrator", "owner"};
}

std::optional<Role> parse_role(std::string_view text) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == text) return static_cast<Role>(i);
  return std::nullopt;
}

std::string_view name(Role role) { return kNames[static_cast<std::size_t>(role)]; }

Role Roles::in(ProjectId project) const {
  const auto own = in_projects.find(project);
  return own == in_projects.end() ? everywhere : std::max(everywhere, own->second);
}

Role Roles::highest() const {
  Role highest = everywhere;
  for (const auto& [project, role] : in_projects) highest = std::max(highest, role);
  return highest;
}

Roles Roles::at_most(Role role) const {
  Roles fewer{std::min(everywhere, role), in_projects};
  for (auto& [project, own] : fewer.in_projects) own = std::min(own, role);
  return fewer;
}

}  // namespace strata
