#pragma once

#include <optional>
#include <string_view>

#include "domain/people/role.h"

namespace strata {

// Which users of a project see a layer, column or attachment. Ascending: each level is visible to
// fewer users. Others get the same answers as for a missing entity.
enum class Visibility {
  everyone,  // "public"
  team,      // annotators and above
  curators,  // "private": curators and above
};
std::optional<Visibility> parse_visibility(std::string_view name);
std::string_view name(Visibility visibility);

// The only rule. `role`: the role in the project.
bool sees(Role role, Visibility visibility);
// Returns the least role that sees it: content computed for everybody with this visibility may only
// read data that this role sees.
Role least_role(Visibility visibility);
// Returns the most restricted visibility that the role sees, which defines all that it sees.
Visibility sight_of(Role role);

}  // namespace strata
