#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>

#include "core/error.h"

namespace strata::net {

// Parses well-known text of one point with three coordinates: `POINT Z(1 2 3)`, `POINT Z (1 2 3)`,
// `POINTZ(1 2 3)` or `POINT(1 2 3)`, in any case. Numbers must be finite.
Result<glm::dvec3> parse_point(std::string_view text);

// Parses a length on the object with its unit, "5mm", "2.5 cm", "1m"; returns meters, from a
// micrometer to 1000 km. Refused: 422 at `field`.
Result<double> parse_length(std::string_view text, const std::string& field);

}  // namespace strata::net
