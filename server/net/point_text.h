#pragma once

#include <glm/glm.hpp>
#include <string_view>

#include "core/problem.h"

namespace strata::net {

// Well-known text of one point with three coordinates: `POINT Z(1 2 3)`, `POINT Z (1 2 3)`, `POINTZ(1 2 3)` or
// `POINT(1 2 3)`, in any case. Numbers must be finite.
Result<glm::dvec3> parse_point(std::string_view text);

}  // namespace strata::net
