#pragma once

#include <optional>
#include <string_view>

#include "domain/people/role.h"

namespace strata {

// Who sees a layer, a column or an attachment of those who see its project. Ascending: each is seen
// by fewer than the one before. Who does not see it gets the answers of what is not there.
enum class Visibility {
  everyone,  // "public"
  team,      // annotators and above
  curators,  // "private": curators and above
};
std::optional<Visibility> parse_visibility(std::string_view name);
std::string_view name(Visibility visibility);

// The one rule. `role`: what they may do in the project.
bool sees(Role role, Visibility visibility);
// The least role that sees it: what is made of things for all who see the one may read only what
// that role sees.
Role least_role(Visibility visibility);
// The least seen of what the role sees. Who sees the same gets the same.
Visibility sight_of(Role role);

}  // namespace strata
