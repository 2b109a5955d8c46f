#include "domain/people/visibility.h"

#include <array>

namespace strata {
namespace {
constexpr std::array<std::string_view, 3> kNames{"public", "team", "private"};
}

std::optional<Visibility> parse_visibility(std::string_view text) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == text) return static_cast<Visibility>(i);
  return std::nullopt;
}

std::string_view name(Visibility visibility) {
  return kNames[static_cast<std::size_t>(visibility)];
}

bool sees(Role role, Visibility visibility) { return role >= least_role(visibility); }

Role least_role(Visibility visibility) {
  switch (visibility) {
    case Visibility::everyone: return Role::viewer;
    case Visibility::team: return Role::annotator;
    case Visibility::curators: break;
  }
  return Role::curator;
}

Visibility sight_of(Role role) {
  if (role >= Role::curator) return Visibility::curators;
  return role == Role::annotator ? Visibility::team : Visibility::everyone;
}

}  // namespace strata
