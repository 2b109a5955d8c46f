#include "expression/operators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace strata {
namespace {

using Op = Expression::Op;
using Form = Operator::Form;

// `Function` is a type, so that each function is compiled into a separate loop.
template <class Function>
void each_of_one(std::span<double> a, std::span<const double>) {
  for (double& value : a) value = Function{}(value);
}
template <class Function>
void each_of_two(std::span<double> a, std::span<const double> b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = Function{}(a[i], b[i]);
}
template <class Test>
std::uint64_t bits_of_two(std::span<const double> a, std::span<const double> b) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits |= std::uint64_t{Test{}(a[i], b[i])} << i;
  return bits;
}
template <class Test>
std::uint64_t bits_of_one(std::span<const double> a, double b) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits |= std::uint64_t{Test{}(a[i], b)} << i;
  return bits;
}

template <class Function>
constexpr Operator infix(Op op, Form form, std::string_view symbol, const char* sql, Function) {
  return {.op = op, .form = form, .name = symbol, .apply = each_of_two<Function>, .sql = sql};
}
template <class Function>
constexpr Operator of_one(Op op, std::string_view name, const char* sql, Function,
                          Form form = Form::number_function) {
  return {.op = op,
          .form = form,
          .name = name,
          .min_operands = 1,
          .max_operands = 1,
          .apply = each_of_one<Function>,
          .sql = sql};
}
template <class Function>
constexpr Operator prefix(Op op, std::string_view symbol, const char* sql, Function function) {
  return of_one(op, symbol, sql, function, Form::sign);
}
template <class Function>
constexpr Operator of_many(Op op, std::string_view name, const char* sql, Function) {
  return {.op = op,
          .form = Form::number_function,
          .name = name,
          .max_operands = Operator::kAny,
          .apply = each_of_two<Function>,
          .sql = sql};
}
template <class Test>
constexpr Operator comparison(Op op, std::string_view symbol, std::string_view alias,
                              const char* sql, const char* times_sql, Test) {
  return {.op = op,
          .form = Form::comparison,
          .name = symbol,
          .alias = alias,
          .compare = bits_of_two<Test>,
          .compare_with = bits_of_one<Test>,
          .sql = sql,
          .times_sql = times_sql};
}
constexpr Operator of_text(Op op, std::string_view name, const char* sql) {
  return {.op = op,
          .form = Form::text_function,
          .name = name,
          .min_operands = 1,
          .max_operands = 1,
          .sql = sql};
}
constexpr Operator of_times(Op op, std::string_view name, const char* times_sql) {
  return {.op = op, .form = Form::time_function, .name = name, .times_sql = times_sql};
}
constexpr Operator of_keys(Op op, std::string_view name, const char* sql) {
  return {.op = op, .form = Form::key_function, .name = name, .sql = sql};
}

constexpr double kRadiansOfDegree = std::numbers::pi / 180;
constexpr double kDegreesOfRadian = 180 / std::numbers::pi;

// The SQL returns NULL for roots, logarithms and powers that have no value. Otherwise PostgreSQL
// would abort the whole query.
constexpr std::array kOperators{
    infix(Op::add, Form::sum, "+", "({a} + {b})", std::plus<>{}),
    infix(Op::subtract, Form::sum, "-", "({a} - {b})", std::minus<>{}),
    infix(Op::multiply, Form::product, "*", "({a} * {b})", std::multiplies<>{}),
    infix(Op::divide, Form::product, "/", "({a} / nullif({b}, 0))", std::divides<>{}),
    infix(Op::remainder, Form::product, "%",
          "CASE WHEN {b} <> 0 THEN {a} - {b} * trunc({a} / {b}) END",
          [](double x, double y) { return std::fmod(x, y); }),
    infix(Op::whole_division, Form::product, "div", "trunc({a} / nullif({b}, 0))",
          [](double x, double y) { return std::trunc(x / y); }),
    infix(
        Op::power, Form::power, "^",
        "CASE WHEN {a} > 0 OR ({a} = 0 AND {b} >= 0) OR ({a} < 0 AND {b} = trunc({b})) THEN power({a}, {b}) END",
        [](double x, double y) { return std::pow(x, y); }),
    prefix(Op::negate, "-", "(- {a})", std::negate<>{}),

    // A time is "before" another if it ends before the other begins, and "after" if it begins after
    // the other ends. With <=, it ends before or with the other. With >=, it begins with or after
    // it.
    comparison(Op::equal, "=", "==", "({a} = {b})", "({a} = {b} AND {a_end} = {b_end})",
               std::equal_to<>{}),
    comparison(Op::not_equal, "<>", "!=", "({a} <> {b})", "({a} <> {b} OR {a_end} <> {b_end})",
               std::not_equal_to<>{}),
    comparison(Op::less, "<", {}, "({a} < {b})", "({a_end} < {b})", std::less<>{}),
    comparison(Op::less_equal, "<=", {}, "({a} <= {b})", "({a_end} <= {b_end})",
               std::less_equal<>{}),
    comparison(Op::greater, ">", {}, "({a} > {b})", "({a} > {b_end})", std::greater<>{}),
    comparison(Op::greater_equal, ">=", {}, "({a} >= {b})", "({a} >= {b})", std::greater_equal<>{}),

    of_many(Op::least, "min", "CASE WHEN {a} <= {b} THEN {a} WHEN {b} < {a} THEN {b} END",
            [](double x, double y) { return std::min(x, y); }),
    of_many(Op::greatest, "max", "CASE WHEN {a} >= {b} THEN {a} WHEN {b} > {a} THEN {b} END",
            [](double x, double y) { return std::max(x, y); }),
    of_one(Op::absolute, "abs", "abs({a})", [](double x) { return std::abs(x); }),
    of_one(Op::square_root, "sqrt", "CASE WHEN {a} >= 0 THEN sqrt({a}) END",
           [](double x) { return std::sqrt(x); }),
    of_one(Op::exponential, "exp", "exp({a})", [](double x) { return std::exp(x); }),
    of_one(Op::natural_log, "ln", "CASE WHEN {a} > 0 THEN ln({a}) END",
           [](double x) { return std::log(x); }),
    of_one(Op::decimal_log, "log10", "CASE WHEN {a} > 0 THEN log({a}) END",
           [](double x) { return std::log10(x); }),
    of_one(Op::floor, "floor", "floor({a})", [](double x) { return std::floor(x); }),
    of_one(Op::ceiling, "ceil", "ceil({a})", [](double x) { return std::ceil(x); }),
    of_one(Op::round, "round", "sign({a}) * floor(abs({a}) + 0.5)",
           [](double x) { return std::round(x); }),
    of_one(Op::sine, "sin", "sin({a})", [](double x) { return std::sin(x); }),
    of_one(Op::cosine, "cos", "cos({a})", [](double x) { return std::cos(x); }),
    of_one(Op::tangent, "tan", "tan({a})", [](double x) { return std::tan(x); }),
    of_one(Op::arc_sine, "asin", "CASE WHEN abs({a}) <= 1 THEN asin({a}) END",
           [](double x) { return std::asin(x); }),
    of_one(Op::arc_cosine, "acos", "CASE WHEN abs({a}) <= 1 THEN acos({a}) END",
           [](double x) { return std::acos(x); }),
    of_one(Op::arc_tangent, "atan", "atan({a})", [](double x) { return std::atan(x); }),
    of_one(Op::radians, "radians", "radians({a})", [](double x) { return x * kRadiansOfDegree; }),
    of_one(Op::degrees, "degrees", "degrees({a})", [](double x) { return x * kDegreesOfRadian; }),

    of_text(Op::fold_case, "casei", "lower({a})"),
    of_text(Op::fold_accents, "accenti",
            "regexp_replace(normalize({a}, NFD), '[\\u0300-\\u036f]', '', 'g')"),

    of_times(Op::before, "t_before", "({a_end} < {b})"),
    of_times(Op::after, "t_after", "({a} > {b_end})"),
    of_times(Op::during, "t_during", "({a} >= {b} AND {a_end} <= {b_end})"),
    of_times(Op::contains, "t_contains", "({b} >= {a} AND {b_end} <= {a_end})"),
    of_times(Op::intersects, "t_intersects", "({a} <= {b_end} AND {b} <= {a_end})"),
    of_times(Op::disjoint, "t_disjoint", "(NOT ({a} <= {b_end} AND {b} <= {a_end}))"),
    of_times(Op::coincides, "t_equals", "({a} = {b} AND {a_end} = {b_end})"),

    of_keys(Op::has_all, "a_contains", "({a} @> {b})"),
    of_keys(Op::has_any, "a_overlaps", "({a} && {b})"),
    of_keys(Op::has_only, "a_containedby", "({a} <@ {b})"),
    of_keys(Op::has_exactly, "a_equals", "({a} = {b})")};

constexpr auto kLastOp = Op::record_truth;

// An array, because the evaluator looks up the row for each block of texels.
constexpr auto kRowOfOp = [] {
  std::array<const Operator*, static_cast<std::size_t>(kLastOp) + 1> rows{};
  for (const Operator& row : kOperators) rows[static_cast<std::size_t>(row.op)] = &row;
  return rows;
}();

}  // namespace

std::span<const Operator> operators() { return kOperators; }

const Operator* find_operator(Op op) { return kRowOfOp[static_cast<std::size_t>(op)]; }

std::string names_of(Form form) {
  std::string names;
  for (const Operator& row : kOperators)
    if (row.form == form) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

}  // namespace strata
