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

// A part of the surface, selected by the values of layers and by its position.
struct Selection {
  std::optional<Expression> where{};  // a condition
  struct Around {
    // The connected surface within a distance from a position (query::select_near).
    Place at;
    double radius = 0;  // in model units
  };
  std::optional<std::variant<Around, Outline>> within{};
  // The texels where any of these layers differs between two states.
  struct Changed {
    std::vector<std::string> layers;  // slugs
    std::int64_t from = 0;
    std::int64_t to = 0;
  };
  std::optional<Changed> changed{};
  At at{};                     // the state of the layers
  Role seen_by = Role::owner;  // `where` can only contain layers that this role sees
  bool whole() const { return !where && !within && !changed; }
};

}  // namespace strata::room
