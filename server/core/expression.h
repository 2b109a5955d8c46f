#pragma once

#include <string>
#include <vector>

namespace strata {

// A formula over the layers of a model: what a fill, a selection or a computed layer is given by, once its text was read
// (query/expression_parser). Either a condition or a number at each texel; which one follows from `op` alone.
//
// Where a layer has no value its number is unknown, and so is what is computed from it: also what has no finite value (1/0).
// Conditions are of three values as in SQL: a comparison with an unknown number is unknown, `false and unknown` is false, `true
// or unknown` is true. Only `valid(layer)` and `known` are always known. Nothing is done where a condition is unknown.
struct Expression {
  enum class Op {
    // numbers
    number,          // `number`; NaN: unknown
    layer,           // the value of the layer whose slug is `layer`
    add,             // of two parts, as the next ones
    subtract,        //
    multiply,        //
    divide,          //
    negate,          // of one part
    absolute,        // of one part
    least,           // of two or more parts
    greatest,        // of two or more parts
    choose,          // parts: a condition, the number where it holds, the number where it does not
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
    // conditions
    truth,          // `number` is 1 or 0
    valid,          // the layer has a value
    known,          // the number is known
    less,           // of two numbers, as the next ones
    less_equal,     //
    greater,        //
    greater_equal,  //
    equal,          //
    not_equal,      //
    all,            // of two or more conditions
    any,            // of two or more conditions
    negation,       // of one condition
  };

  Op op = Op::number;
  double number = 0;
  std::string layer;
  std::vector<Expression> parts;

  bool is_condition() const { return op >= Op::truth; }
  bool operator==(const Expression&) const = default;
};

// Slugs of the layers that it reads, each once, in order of their first use.
std::vector<std::string> layers_of(const Expression& expression);

}  // namespace strata
