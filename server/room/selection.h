#pragma once

#include <optional>
#include <variant>

#include "domain/people/role.h"
#include "expression/expression.h"
#include "room/at.h"
#include "room/place.h"

namespace strata::room {

// A part of the surface, by the values of layers and by its place.
struct Selection {
  std::optional<Expression> where{};  // a condition
  struct Around {
    // the surface connected with a place within a distance from it (query::select_near)
    Place at;
    double radius = 0;  // model units
  };
  std::optional<std::variant<Around, Outline>> within{};
  At at{};                     // of the layers
  Role seen_by = Role::owner;  // `where` cannot name layers that this role does not see
  bool whole() const { return !where && !within; }
};

}  // namespace strata::room
