#pragma once

#include <optional>
#include <string_view>

#include "domain/people/role.h"

namespace strata {

// The users of a project who see a layer, column or attachment. Each level has fewer users than the
// previous level. Other users get the same responses as for an entity that does not exist.
enum class Visibility {
  everyone,  // "public"
  team,      // annotators and above
  curators,  // "private": curators and above
};
std::optional<Visibility> parse_visibility(std::string_view name);
std::string_view name(Visibility visibility);

// Returns whether this role in the project sees the entity. This is the only rule for visibility.
bool sees(Role role, Visibility visibility);
// Returns the lowest role that sees entities of this visibility. If the server computes content
// for all users with that role, it must only use data that the role sees.
Role least_role(Visibility visibility);
// Returns the most restricted visibility that the role sees. The role also sees all less restricted
// entities.
Visibility sight_of(Role role);

}  // namespace strata
