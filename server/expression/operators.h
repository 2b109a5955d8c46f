#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "expression/expression.h"

namespace strata {

// A row of the table of operators and functions: the syntax, the operands, and the evaluation at
// texels and in the database. Elements with a separate grammar are not in it: names, literals,
// choices, `like`, `and`, `or`, `not`, tests for known values.
struct Operator {
  // The place in the grammar and the kind of the operands.
  enum class Form {
    sum,  // infix, of numbers, as the next three; in order of increasing precedence
    product,
    power,
    sign,        // prefix, of a number
    comparison,  // infix, of two numbers, two texts or two times
    number_function,
    text_function,
    time_function,  // of two times
    key_function,   // of a relation and keys
  };
  static constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

  Expression::Op op;
  Form form;
  std::string_view name;     // the syntax
  std::string_view alias{};  // an alternative syntax
  std::size_t min_operands = 2, max_operands = 2;

  // For numbers: replaces a by the result; b is empty for one operand. Non-finite means unknown.
  void (*apply)(std::span<double> a, std::span<const double> b) = nullptr;
  // For comparisons of numbers, at most 64: sets a bit for each that is true; the second function
  // has one number on the right.
  std::uint64_t (*compare)(std::span<const double> a, std::span<const double> b) = nullptr;
  std::uint64_t (*compare_with)(std::span<const double> a, double b) = nullptr;

  // The PostgreSQL expression over {a} and {b}; NULL without a value.
  const char* sql = nullptr;
  // For times, which have a first and a last moment: over {a}, {a_end}, {b} and {b_end}.
  const char* times_sql = nullptr;

  bool is_called(std::string_view text) const {
    return text == name || (!alias.empty() && text == alias);
  }
};

// All operators; those of one form are in the order in which messages list them.
std::span<const Operator> operators();

// Returns the row of an operation; null for one with a separate grammar.
const Operator* find_operator(Expression::Op op);

// "min, max, …": the names of the functions of a form.
std::string names_of(Operator::Form form);

}  // namespace strata
