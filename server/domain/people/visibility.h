#pragma once

#include <optional>
#include <string_view>

#include "domain/people/role.h"

namespace strata {

// Which users of a project see a layer, column or attachment. Each level is visible to fewer users
// than the one before it. Other users get the same responses as for an entity that does not exist.
enum class Visibility {
  everyone,  // "public"
  team,      // annotators and above
  curators,  // "private": curators and above
};
std::optional<Visibility> parse_visibility(std::string_view name);
std::string_view name(Visibility visibility);

// The only rule for visibility. `role` is the role in the project.
bool sees(Role role, Visibility visibility);
// Returns the lowest role that sees entities of this visibility. Content that is computed for all
// users with that role may only be computed from data that the role sees.
Role least_role(Visibility visibility);
// Returns the most restricted visibility that the role sees. It determines everything that the role
// sees.
Visibility sight_of(Role role);

}  // namespace strata
