#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "expression/expression.h"

namespace strata {

// One row of the table of operators and functions: how it is written, what it takes, and how it is
// worked out, at texels and in the database. What is not here has a grammar of its own: names,
// literals, choices, `like`, `and`, `or`, `not`, tests for what is known.
struct Operator {
  // Where it stands in the grammar and what its operands are.
  enum class Form {
    sum,  // infix, of numbers, as the next three; each binds more tightly than the one before
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
  std::string_view name;     // as it is written
  std::string_view alias{};  // as it may be written, too
  std::size_t min_operands = 2, max_operands = 2;

  // Of numbers: a becomes the result; of one operand b is empty. What is not finite is unknown.
  void (*apply)(std::span<double> a, std::span<const double> b) = nullptr;
  // Of a comparison of numbers, 64 at most: a bit for each that holds; with one number on the
  // right.
  std::uint64_t (*compare)(std::span<const double> a, std::span<const double> b) = nullptr;
  std::uint64_t (*compare_with)(std::span<const double> a, double b) = nullptr;

  // PostgreSQL of it over {a} and {b}; NULL where it has no value.
  const char* sql = nullptr;
  // Of times, which have a first and a last moment: over {a}, {a_end}, {b} and {b_end}.
  const char* times_sql = nullptr;

  bool is_called(std::string_view text) const {
    return text == name || (!alias.empty() && text == alias);
  }
};

// All of them; those of one form in the order in which messages list them.
std::span<const Operator> operators();

// The row of an operation; nothing for those with a grammar of their own.
const Operator* find_operator(Expression::Op op);

// "min, max, …": the names of the functions of a form.
std::string names_of(Operator::Form form);

}  // namespace strata
