#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "domain/scene/up.h"

namespace strata::query {

// Returns the numbers of the places in the order in which people read them in the front view: in
// ten rows of equal height from top to bottom, and from left to right in each row. Places on the
// floor, whose heights differ by less than a tenth of their extent in depth, are read in the view
// from above. Equal places keep their order.
std::vector<std::uint32_t> reading_order(std::span<const glm::dvec3> places, const UpFrame& frame);

}  // namespace strata::query
