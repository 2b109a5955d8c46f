#pragma once

#include <string>

#include "core/error.h"
#include "protocol/messages.h"

namespace strata::bill {

inline constexpr std::size_t kMaxMeasurements = 10'000;  // of a bill

// Checks what the schema cannot express, without the database: ordinal numbers are unique and their
// groups precede them, groups have no content of positions, rules have a source and the members of
// their measure, the measure fits the unit of the position, and formulas can be computed. The error
// names the field: "items[3].rules[0].depth".
Result<void> check_bill(const protocol::BillWrite& bill);

// Sets the author and time of hand measurements. Lines that `before` has with the same content keep
// theirs. All others get `user` and `time`, also if the client sent other ones.
void sign_measurements(protocol::BillWrite& bill, const protocol::BillWrite& before,
                       const std::string& user, const std::string& time);

}  // namespace strata::bill
