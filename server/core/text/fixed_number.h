#pragma once

#include <string>

namespace strata {

// Appends a finite number with at most this number of decimals, without zeros at its end and
// without an exponent: "12.5", "-3", "0".
void append_fixed(std::string& text, double value, int decimals);

}  // namespace strata
