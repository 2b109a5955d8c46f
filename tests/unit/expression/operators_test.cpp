// The table of operators. The parser must accept each row.
#include "expression/operators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "expression/expression_parser.h"

namespace strata {
namespace {

using Form = Operator::Form;

bool is_function(Form form) { return form >= Form::number_function; }

// Returns a formula that writes the operator as `name`.
std::string formula(const Operator& row, std::string_view name) {
  const std::string written(name);
  switch (row.form) {
    case Form::sign: return written + "a = 1";
    case Form::comparison: return "a " + written + " b";
    case Form::number_function: return written + (row.min_operands == 1 ? "(a) = 1" : "(a, b) = 1");
    case Form::text_function: return written + "(a) = 'x'";
    case Form::time_function: return written + "(a, date('2024'))";
    case Form::key_function: return written + "(a, (1, 2))";
    default: return "a " + written + " b = 1";
  }
}

bool holds(const Expression& expression, Expression::Op op) {
  if (expression.op == op) return true;
  for (const Expression& part : expression.parts)
    if (holds(part, op)) return true;
  return false;
}

TEST(Operators, the_parser_reads_every_row) {
  for (const Operator& row : operators())
    for (const std::string_view name : {row.name, row.alias}) {
      if (name.empty()) continue;
      const std::string text = formula(row, name);
      const auto read = query::parse_condition(text, "where", query::Names::columns);
      ASSERT_TRUE(read) << text << ": " << read.error().detail;
      EXPECT_TRUE(holds(*read, row.op)) << text;
    }
}

TEST(Operators, each_has_one_row_and_functions_one_name) {
  std::set<Expression::Op> ops;
  std::set<std::string_view> names;
  for (const Operator& row : operators()) {
    EXPECT_TRUE(ops.insert(row.op).second) << row.name;
    EXPECT_EQ(find_operator(row.op), &row);
    if (is_function(row.form)) {
      EXPECT_TRUE(names.insert(row.name).second) << row.name;
    }
  }
  EXPECT_EQ(find_operator(Expression::Op::all), nullptr);
}

TEST(Operators, each_says_how_it_is_worked_out) {
  for (const Operator& row : operators()) {
    SCOPED_TRACE(row.name);
    EXPECT_LE(row.min_operands, row.max_operands);
    const bool of_numbers = row.form <= Form::sign || row.form == Form::number_function;
    EXPECT_EQ(row.apply != nullptr, of_numbers);
    EXPECT_EQ(row.compare != nullptr, row.form == Form::comparison);
    EXPECT_EQ(row.compare_with != nullptr, row.form == Form::comparison);
    EXPECT_EQ(row.times_sql != nullptr,
              row.form == Form::comparison || row.form == Form::time_function);
    EXPECT_EQ(row.sql != nullptr, row.form != Form::time_function);
    const std::string_view sql = row.sql ? row.sql : row.times_sql;
    EXPECT_NE(sql.find("{a}"), sql.find("{a_end}"));
    EXPECT_EQ(sql.find("{b") != std::string_view::npos, row.max_operands > 1);
  }
}

TEST(Operators, comparisons_have_a_bit_for_each_number) {
  const Operator& less = *find_operator(Expression::Op::less);
  const std::vector<double> a{1, 2, 3, -4}, b{2, 2, 4, -5};
  EXPECT_EQ(less.compare(a, b), 0b0101u);
  EXPECT_EQ(less.compare_with(a, 2), 0b1001u);
}

TEST(Operators, numbers_are_computed_in_place) {
  std::vector<double> a{7.5, -7.5, 1};
  const std::vector<double> b{2, 2, 0};
  find_operator(Expression::Op::remainder)->apply(a, b);
  EXPECT_EQ(a[0], 1.5);
  EXPECT_EQ(a[1], -1.5) << "of a division towards zero";
  EXPECT_FALSE(std::isfinite(a[2]));
  find_operator(Expression::Op::negate)->apply(a, {});
  EXPECT_EQ(a[0], -1.5);
}

}  // namespace
}  // namespace strata
