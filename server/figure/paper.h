#pragma once

namespace strata::figure {

inline constexpr double kInch_mm = 25.4;

}  // namespace strata::figure
