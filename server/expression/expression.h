#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

// A parsed formula (expression/expression_parser) of a fill, a selection, a filter of records or a
// computed layer: a condition, a number, a text or a time at each texel or record.
//
// A missing value of a layer or column is unknown, and so is a result computed from it, or a result
// that is not finite (1/0). Conditions are three-valued as in SQL: a comparison with an unknown
// number is unknown, `false and unknown` is false, `true or unknown` is true. Only `valid(layer)`
// and `known` are always known. Where a condition is unknown, it has no effect.
struct Expression {
  enum class Op {
    // numbers
    number,          // `number`; NaN: unknown
    layer,           // the value of the layer whose slug is `name`
    add,             // of two parts, as the next ones
    subtract,        //
    multiply,        //
    divide,          //
    negate,          // of one part
    absolute,        // of one part
    least,           // of two or more parts
    greatest,        // of two or more parts
    choose,          // parts: a condition, the number if it is true, the number if it is false
    power,           // of two parts, as the next ones
    remainder,       // of a division towards zero
    whole_division,  // the quotient without its fraction
    square_root,     // of one part, as the next ones
    exponential,     //
    natural_log,     //
    decimal_log,     //
    floor,           //
    ceiling,         //
    round,           // halves away from zero
    sine,            // of radians, as the next ones
    cosine,          //
    tangent,         //
    arc_sine,        // in radians, as the next ones
    arc_cosine,      //
    arc_tangent,     //
    radians,         // of degrees
    degrees,         // of radians
    x,               // of the texel's position in the world, model units, as the next ones
    y,               //
    z,               //
    area,            // of the texel, m²
    // number `index` of the values read from records (expression/record_parts), for the key that
    // the layer `name` holds
    record_number,
    // of any kind
    // `path` of a record: the one whose key the layer `name` holds, or, without a name, the
    // filtered record
    column,
    // texts, which also write times: ISO 8601, EDTF
    text,          // `text`
    fold_case,     // of one part
    fold_accents,  // of one part
    keys,          // of records: parts are numbers
    // conditions
    truth,          // `number` is 1 or 0
    valid,          // the layer has a value
    known,          // the part is known
    less,           // of two parts of one kind, as the next ones
    less_equal,     //
    greater,        //
    greater_equal,  //
    equal,          //
    not_equal,      //
    // of a text and a pattern: % for any characters, _ for one, \ before a literal character
    like,
    all,           // of two or more conditions
    any,           // of two or more conditions
    negation,      // of one condition
    holds,         // of a column of booleans
    before,        // of two times, as the next ones: all of the first is before all of the second
    after,         //
    during,        // the first is within the second
    contains,      // the second is within the first
    intersects,    // they have a moment in common
    disjoint,      // they have no moment in common
    coincides,     // they begin and end together
    has_all,       // of a relation and keys: it contains all of them
    has_any,       // it contains one of them
    has_only,      // it contains only them
    has_exactly,   // it contains exactly them
    record_truth,  // as record_number
  };

  // Position in the source text, in characters (Unicode code points); not compared.
  struct Position {
    std::size_t at = 0;      // characters before it
    std::size_t length = 0;  // of a name or text; 0 for others
    bool operator==(const Position&) const { return true; }
  };

  Op op = Op::number;
  double number = 0;
  std::string name;  // slug of a layer
  // slugs of columns: of the record, then of the record whose key the previous column holds
  std::vector<std::string> path;
  std::string text;
  std::size_t index = 0;
  std::vector<Expression> parts;
  Position position;

  bool is_condition() const { return op >= Op::truth; }
  bool is_text() const { return op == Op::text || op == Op::fold_case || op == Op::fold_accents; }
  bool is_column() const { return op == Op::column; }
  bool operator==(const Expression&) const = default;
};

// Kinds of mistakes in an expression. Programs can depend on the names
// (docs/reference/errors.md).
namespace mistake {
inline constexpr std::string_view kSyntax = "syntax";
inline constexpr std::string_view kExpectsCondition = "expects_condition";  // but got a number
inline constexpr std::string_view kExpectsNumber = "expects_number";        // but got a condition
inline constexpr std::string_view kUnknownLayer = "unknown_layer";
inline constexpr std::string_view kUnknownColumn = "unknown_column";
inline constexpr std::string_view kUnknownFunction = "unknown_function";
inline constexpr std::string_view kUnknownChoice = "unknown_choice";  // of a column of choices
inline constexpr std::string_view kUnit = "unit";                     // after a number
inline constexpr std::string_view kWrongType = "wrong_type";          // of a column or value
inline constexpr std::string_view kComputedLayersOnly = "computed_layers_only";
inline constexpr std::string_view kTooLarge = "too_large";
}  // namespace mistake

// Returns an Error (invalid) for a mistake at a character (from 0) of an expression's text.
// `suggestions` are texts that would correct the characters of `position`.
Error expression_problem(const std::string& what, Expression::Position position,
                         const std::string& field, std::string_view reason = mistake::kSyntax,
                         std::vector<std::string> suggestions = {});

// Returns the slugs of the layers that it reads, each once, in order of their first use.
std::vector<std::string> layers_of(const Expression& expression);

// Whether it reads a column of a record.
bool reads_records(const Expression& expression);

}  // namespace strata
