#pragma once

#include <optional>
#include <string_view>

#include "protocol/messages.h"

namespace strata::bill {

// Returns the measure that has this unit in bills: m2, m² and qm for areas, m and lfm for lengths,
// m3, m³ and cbm for volumes, St, Stk, Stck and pcs for counts. Ignores case. Returns nullopt for
// other units, such as psch and h, whose positions have hand measurements only.
std::optional<protocol::BillRuleMeasure> measure_of_unit(std::string_view unit);

// Returns the unit that bills usually have for a measure: m2, m, m3 or St.
std::string_view usual_unit(protocol::BillRuleMeasure measure);

// Returns the length of a unit of depths, mm, cm or m, in meters, or nullopt for other units.
std::optional<double> metres_of_unit(std::string_view unit);

}  // namespace strata::bill
