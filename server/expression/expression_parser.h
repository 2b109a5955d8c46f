#pragma once

#include <string>
#include <string_view>

#include "core/error.h"
#include "expression/expression.h"

namespace strata::query {

constexpr std::size_t kMaxExpressionLength = 4096;  // bytes of the text
constexpr int kMaxExpressionDepth = 64;             // of nested parts

// The meaning of a name without a dot before it: a layer, as in formulas over a surface, or a
// column, as in filters of records.
enum class Names { layers, columns };

// Parses the text of a formula: OGC CQL2 text, with functions of numbers. In order of precedence,
// the lowest first:
//
//   or · and · not
//   = <> < <= > >= (also == and !=) · [not] between a and b · [not] in (a, b, …)
//   · [not] like 'pattern' · is [not] null
//   + - · * / % div · ^ · - (sign)
//   numbers (0.3, 2e-4), texts ('it''s'), true, false, null (unknown), names, ( … )
//   valid(layer), if(condition, number, number),
//   case when condition then number … [else number] end
//   reclass(number, below, limit, value, limit, value, …): ascending limits, from each on its value
//   min(a, b, …), max(a, b, …), abs, sqrt, exp, ln, log10, floor, ceil, round, sin, cos, tan,
//   asin, acos, atan (radians), radians, degrees
//   casei(text), accenti(text): without regard to case, to accents
//   date('2024-05-02'), timestamp('…'), interval('1560', '..'), and any EDTF in quotes;
//   t_before, t_after, t_during, t_contains, t_intersects, t_disjoint, t_equals of two times
//   a_contains, a_overlaps, a_containedby, a_equals of a relation and (key, key, …)
//
// Words are case-insensitive. Layers and columns are named by their slugs; `layer.column` is a
// column of the record whose key the layer holds, `column.column` of the record that a column
// refers to. A hyphen between two characters of a name belongs to it, so a subtraction needs
// spaces. Names that begin with a digit or are words of this language need double quotes. As in
// PostgreSQL the sign has a higher precedence than the power: -2 ^ 2 is 4. Without `else` a case is
// unknown if no condition is true. Refused (invalid at `field`, with the position): syntax errors,
// a condition instead of a number and the reverse, texts that are too long or too deeply nested.
// The caller checks that layers and columns exist, and their types.
Result<Expression> parse_condition(std::string_view text, const std::string& field,
                                   Names names = Names::layers);
Result<Expression> parse_number(std::string_view text, const std::string& field,
                                Names names = Names::layers);

// Returns the slug of a layer or column as an expression has to contain it: in double quotes if it
// begins with a digit or is a word of the language.
std::string name_in_expression(const std::string& slug);
// Returns a text as an expression has to contain it, in single quotes.
std::string text_in_expression(std::string_view text);

}  // namespace strata::query
