#pragma once

#include <optional>
#include <variant>

#include "domain/people/role.h"
#include "expression/expression.h"
#include "room/at.h"
#include "room/place.h"

namespace strata::room {

// A part of the surface, by what the layers held and where it lies.
struct Selection {
  std::optional<Expression> where{};  // a condition
  struct Around {
    // connected with a place within a distance from it (query::select_near)
    Place at;
    double radius = 0;  // model units
  };
  std::optional<std::variant<Around, Outline>> within{};
  At at{};                     // of the layers
  Role seen_by = Role::owner;  // what this role does not see `where` cannot name
  bool whole() const { return !where && !within; }
};

}  // namespace strata::room
