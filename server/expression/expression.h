#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

// A parsed formula (expression/expression_parser) for a fill, a selection, a filter of records or a
// computed layer. Its result at each texel or record is a condition, a number, a text or a time.
//
// The missing value of a layer or column is unknown. A result is unknown if it is computed from an
// unknown value or is not finite (1/0). Conditions have three values, as in SQL. A comparison with
// an unknown number is unknown, `false and unknown` is false, and `true or unknown` is true. Only
// `valid(layer)` and `known` are never unknown. An unknown condition has no effect.
struct Expression {
  enum class Op {
    // numbers
    number,          // `number`; NaN if unknown
    layer,           // the value of the layer whose slug is `name`
    add,             // takes two parts, like the next three
    subtract,        //
    multiply,        //
    divide,          //
    negate,          // takes one part
    absolute,        // takes one part
    least,           // takes two or more parts
    greatest,        // takes two or more parts
    choose,          // parts: a condition, the number if it is true, and the number if it is false
    power,           // takes two parts, like the next two
    remainder,       // the quotient is rounded towards zero
    whole_division,  // the quotient without its fraction
    square_root,     // takes one part, like the next six
    exponential,     //
    natural_log,     //
    decimal_log,     //
    floor,           //
    ceiling,         //
    round,           // rounds halves away from zero
    sine,            // takes an angle in radians, like the next two
    cosine,          //
    tangent,         //
    arc_sine,        // returns an angle in radians, like the next two
    arc_cosine,      //
    arc_tangent,     //
    radians,         // converts from degrees
    degrees,         // converts from radians
    x,               // position of the texel in the world, in model units, like the next two
    y,               //
    z,               //
    area,            // of the texel, in m²
    // Along the surface (expression/surface_functions), up to the distance `number` in model units;
    // infinity if there is no limit.
    distance,       // from the nearest texel where the part, a condition, is true
    nearest,        // takes a number: its value at the nearest texel where it is known
    focal_mean,     // of a number at the texels around, like the next three
    focal_min,      //
    focal_max,      //
    focal_variety,  // the number of different values
    hot_spot,       // the z-score of a number at the texels around
    // How likely chance makes such a score; the second part is the number of permutations.
    hot_spot_chance,
    watershed,  // the number of the basin of a number, of basins at least `number` deep
    run_off,    // water that passes, from the rain on each place
    valley,     // the depth of lines of low values with the width `number`
    ridge,      // the height of lines of high values, likewise
    // 1 where the first part is above the second, in a connected piece with a value above `number`.
    hysteresis,
    // Clean-ups of a number, or of a condition, whose result is 1 or unknown.
    sieve,       // without regions whose area is less than `number`, in square model units
    fill_holes,  // with the value around them in holes of less than this area
    majority,    // the most frequent value at the texels around
    opening,     // of a condition: without parts narrower than `number`
    closing,     // of a condition: with gaps narrower than `number`
    // Along the surface, from the readings of a number (query/interpolation/interpolate) and the
    // range `number`.
    interpolated,         // the expected value
    interpolation_error,  // its standard error
    // The number at `index` of the values that are read from records (expression/record_parts), for
    // the key in the layer `name`.
    record_number,
    // Of any type: the column `path` of the record whose key is in the layer `name`. Without a
    // name, the column of the filtered record.
    column,
    // Texts. They also represent times (ISO 8601, EDTF).
    text,          // `text`
    fold_case,     // takes one part
    fold_accents,  // takes one part
    keys,          // keys of records; the parts are numbers
    // Conditions.
    truth,          // `number` is 1 or 0
    valid,          // the layer has a value
    known,          // the part is known
    less,           // compares two parts of one type, like the next five
    less_equal,     //
    greater,        //
    greater_equal,  //
    equal,          //
    not_equal,      //
    // Compares a text with a pattern: % matches any characters, _ matches one character, and a
    // literal character follows \ (backslash).
    like,
    all,           // takes two or more conditions
    any,           // takes two or more conditions
    negation,      // takes one condition
    holds,         // takes a column of booleans
    before,        // takes two times, like the next six: the first ends before the second begins
    after,         // the first begins after the second ends
    during,        // the first is within the second
    contains,      // the second is within the first
    intersects,    // the times have a moment in common
    disjoint,      // the times have no moment in common
    coincides,     // the times have the same beginning and end
    has_all,       // takes a relation and keys, like the next three: the relation has all of them
    has_any,       // has at least one of the keys
    has_only,      // has no other keys
    has_exactly,   // has the keys and no others
    record_truth,  // like record_number, for a condition
  };

  // The position in the source text, in characters (Unicode code points). Ignored in comparisons.
  struct Position {
    std::size_t at = 0;      // number of characters before the position
    std::size_t length = 0;  // of a name or text; 0 for other parts
    bool operator==(const Position&) const { return true; }
  };

  Op op = Op::number;
  double number = 0;
  std::string name;  // slug of a layer
  // Slugs of columns: first a column of the record, then columns of the record whose key the
  // previous column holds.
  std::vector<std::string> path;
  std::string text;
  std::size_t index = 0;
  std::vector<Expression> parts;
  Position position;

  bool is_condition() const { return op >= Op::truth; }
  bool is_text() const { return op == Op::text || op == Op::fold_case || op == Op::fold_accents; }
  bool is_column() const { return op == Op::column; }
  bool is_surface_function() const { return op >= Op::distance && op <= Op::interpolation_error; }
  // Whether the result is always one of the values of the part: nearest values and clean-ups.
  bool chooses_value() const { return op == Op::nearest || (op >= Op::sieve && op <= Op::closing); }
  bool operator==(const Expression&) const = default;
};

// Kinds of mistakes in an expression. Programs can depend on the names of the kinds
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

// Returns an `invalid` Error for a mistake at a character (counted from 0) of an expression.
// `suggestions` are texts that correct the mistake if they replace the characters at `position`.
Error expression_problem(const std::string& what, Expression::Position position,
                         const std::string& field, std::string_view reason = mistake::kSyntax,
                         std::vector<std::string> suggestions = {});

// Returns the slugs of the layers that the expression reads, without duplicates, in the order of
// their first use.
std::vector<std::string> layers_of(const Expression& expression);

// Returns whether the expression reads a column of a record.
bool reads_records(const Expression& expression);

// Returns whether the expression contains a function along the surface.
bool has_surface_function(const Expression& expression);

}  // namespace strata
