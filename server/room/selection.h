#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

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
  // Where any of these layers differs between two states.
  struct Changed {
    std::vector<std::string> layers;  // slugs
    std::int64_t from = 0;
    std::int64_t to = 0;
  };
  std::optional<Changed> changed{};
  At at{};                     // of the layers
  Role seen_by = Role::owner;  // `where` cannot name layers that this role does not see
  bool whole() const { return !where && !within && !changed; }
};

}  // namespace strata::room
