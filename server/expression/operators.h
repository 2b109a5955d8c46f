#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "expression/expression.h"

namespace strata {

// A row in the table of operators and functions, with the syntax, the operands, and the evaluation
// at texels and in the database. The table does not contain elements that have their own grammar:
// names, literals, choices, `like`, `and`, `or`, `not`, and tests for known values.
struct Operator {
  // The position in the grammar and the type of the operands.
  enum class Form {
    sum,  // infix, of numbers, like the next two; in order of increasing precedence
    product,
    power,
    sign,        // prefix, of a number
    comparison,  // infix, of two numbers, two texts or two times
    number_function,
    text_function,
    time_function,  // of two times
    key_function,   // of a relation and a list of keys
  };
  static constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

  Expression::Op op;
  Form form;
  std::string_view name;     // the name in the syntax
  std::string_view alias{};  // an alternative name
  std::size_t min_operands = 2, max_operands = 2;

  // For numbers: replaces each number in `a` by the result. `b` is empty if the operation has one
  // operand. A result that is not finite is unknown.
  void (*apply)(std::span<double> a, std::span<const double> b) = nullptr;
  // For comparisons of at most 64 numbers: sets the bit of each comparison that is true. The second
  // function compares with one number on the right.
  std::uint64_t (*compare)(std::span<const double> a, std::span<const double> b) = nullptr;
  std::uint64_t (*compare_with)(std::span<const double> a, double b) = nullptr;

  // The PostgreSQL expression over {a} and {b}. It returns NULL if the operation has no result.
  const char* sql = nullptr;
  // The expression for times, over {a}, {a_end}, {b} and {b_end}. A time has a first and a last
  // moment.
  const char* times_sql = nullptr;

  bool is_called(std::string_view text) const {
    return text == name || (!alias.empty() && text == alias);
  }
};

// Returns all operators. Operators with the same form are in the order in which messages list them.
std::span<const Operator> operators();

// Returns the row of an operation, or null if the operation has its own grammar.
const Operator* find_operator(Expression::Op op);

// Returns the names of the functions with this form: "min, max, …".
std::string names_of(Operator::Form form);

}  // namespace strata
