#pragma once

#include <string>
#include <string_view>

#include "core/error.h"
#include "expression/expression.h"

namespace strata::query {

constexpr std::size_t kMaxExpressionLength = 4096;  // bytes of the text
constexpr int kMaxExpressionDepth = 64;             // of nested parts

// The meaning of a name that no dot precedes: a layer in formulas over a surface, or a column in
// filters of records.
enum class Names { layers, columns };

// Parses a formula: OGC CQL2 text with numeric functions. In order of precedence, the lowest first:
//
//   or · and · not
//   = <> < <= > >= (also == and !=) · [not] between a and b · [not] in (a, b, …)
//   · [not] like 'pattern' · is [not] null
//   + - · * / % div · ^ · - (sign)
//   numbers (0.3, 2e-4), texts ('it''s'), true, false, null (unknown), names, ( … )
//   valid(layer), if(condition, number, number),
//   case when condition then number … [else number] end
//   reclass(number, below, limit, value, limit, value, …), with ascending limits;
//   each value applies from its limit
//   min(a, b, …), max(a, b, …), abs, sqrt, exp, ln, log10, floor, ceil, round, sin, cos, tan,
//   asin, acos, atan (radians), radians, degrees
//   casei(text), accenti(text): ignore case, ignore accents
//   date('2024-05-02'), timestamp('…'), interval('1560', '..'), and any EDTF in quotes;
//   t_before, t_after, t_during, t_contains, t_intersects, t_disjoint, t_equals of two times
//   a_contains, a_overlaps, a_containedby, a_equals of a relation and (key, key, …)
//   distance(condition[, limit]), within(condition, limit), nearest(number[, limit]): along the
//   surface, only in computed layers; a layer in place of the condition means valid(layer);
//   within(c, d) is the same as distance(c, d) is not null
//   focal_mean, focal_min, focal_max, focal_variety, hot_spot of (number, radius),
//   hot_spot_chance(number, radius[, permutations]), valley and ridge of (number, width),
//   interpolated and interpolation_error of (number, range), watershed(number, height),
//   run_off(number): likewise
//   hysteresis(number, low, high): likewise, a condition
//   sieve and fill_holes of (number or condition, area), majority(number or condition, radius),
//   opening and closing of (condition, width): likewise; a condition if the argument is one
//
// Words are case-insensitive. Layers and columns are named by their slugs. `layer.column` is a
// column of the record whose key the layer holds. `column.column` is a column of the record that a
// column refers to. A hyphen between two characters of a name is part of the name, so a subtraction
// needs spaces. A name that begins with a digit or is a keyword needs double quotes. As in
// PostgreSQL, a minus sign has a higher precedence than `^`: -2 ^ 2 is 4. Without `else`, a case
// is unknown if no condition is true. Returns an `invalid` error at `field`, with the position, for
// a syntax error, a condition instead of a number or the reverse, and a text that is too long or
// too deeply nested. The caller must check that the layers and columns exist, and check their
// types.
Result<Expression> parse_condition(std::string_view text, const std::string& field,
                                   Names names = Names::layers);
Result<Expression> parse_number(std::string_view text, const std::string& field,
                                Names names = Names::layers);

// Returns the slug of a layer or column as an expression must contain it. The slug is in double
// quotes if it begins with a digit or is a keyword.
std::string name_in_expression(const std::string& slug);
// Returns a text as an expression must contain it, in single quotes.
std::string text_in_expression(std::string_view text);

}  // namespace strata::query
