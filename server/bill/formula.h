#pragma once

#include <string>
#include <string_view>

#include "bill/exact_number.h"
#include "core/error.h"

namespace strata::bill {

inline constexpr std::size_t kMaxFormula = 500;  // bytes

// Computes the formula of a hand measurement without rounding: "2 * 1,20 * 0,85". Accepts numbers
// with a decimal comma or point, + - * / (also x, × and : as in measurement sheets), whole powers
// with ^, ² or ³, and parentheses. A `=` at the end, as in REB 23.003, has no effect. Returns an
// `invalid` error at `field`, with the place of the mistake, for other texts, a division by zero,
// and results that are too large or have too many different divisors.
Result<ExactNumber> compute_formula(std::string_view text, const std::string& field);

}  // namespace strata::bill
