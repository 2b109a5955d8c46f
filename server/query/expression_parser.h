#pragma once

#include <string>
#include <string_view>

#include "core/expression.h"
#include "core/problem.h"

namespace strata::query {

constexpr std::size_t kMaxExpressionLength = 4096;  // bytes of the text
constexpr int kMaxExpressionDepth = 64;             // of nested parts

// Reads the text of a formula: OGC CQL2 text over numbers, with functions. In order of binding, the loosest first:
//
//   or · and · not
//   = <> < <= > >= (also == and !=) · [not] between a and b · [not] in (a, b, …) · is [not] null
//   + - · * / % div · ^ · - (sign)
//   numbers (0.3, 2e-4), true, false, null (unknown), names of layers, ( … )
//   valid(layer), if(condition, number, number), case when condition then number … [else number] end
//   min(a, b, …), max(a, b, …), abs, sqrt, exp, ln, log10, floor, ceil, round, sin, cos, tan, asin, acos, atan (radians), radians, degrees
//
// Words are of any case. A layer is named by its slug; a hyphen between two of its characters belongs to the name, so
// a subtraction needs spaces. Names that begin with a digit or are words of this language stand in double quotes. As in PostgreSQL
// the sign binds more tightly than the power: -2 ^ 2 is 4. Without `else` a case is unknown where no condition holds.
// Refused (422 at `field`, with the position): what cannot be read, conditions where numbers are wanted and the reverse, too
// long or too deeply nested texts. Whether the layers exist is for the caller to find out.
Result<Expression> parse_condition(std::string_view text, const std::string& field);
Result<Expression> parse_number(std::string_view text, const std::string& field);

}  // namespace strata::query
