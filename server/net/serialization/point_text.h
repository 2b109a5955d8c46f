#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>

#include "core/error.h"

namespace strata::net {

// Parses the well-known text of a point with three coordinates, in any case: `POINT Z(1 2 3)`,
// `POINT Z (1 2 3)`, `POINTZ(1 2 3)` or `POINT(1 2 3)`. Refuses numbers that are not finite.
Result<glm::dvec3> parse_point(std::string_view text);

// Parses a length on the object with its unit, such as "5mm", "2.5 cm" or "1m". Returns meters. The
// length must be between a micrometer and 1000 km. Returns 422 at `field` for invalid text.
Result<double> parse_length(std::string_view text, const std::string& field);

}  // namespace strata::net
