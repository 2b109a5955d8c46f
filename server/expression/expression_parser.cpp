#include "expression/expression_parser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/text/closest.h"
#include "core/text/edtf.h"
#include "core/text/timestamp.h"
#include "expression/operators.h"
#include "expression/surface_functions.h"
#include "expression/token_reader.h"

namespace strata::query {
namespace {

using Op = Expression::Op;
using Form = Operator::Form;

constexpr std::array<std::string_view, 16> kKeywords{
    "and",  "or",  "not", "true",    "false", "case", "when", "then",
    "else", "end", "is",  "between", "in",    "null", "like", "div"};
// A recursive descent parser. After an error, the text has ended, so every level returns, and its
// result is not used.
class Parser : private TokenReader {
 public:
  Parser(std::string_view text, const std::string& field, Names names)
      : TokenReader(text, field), names_(names) {}

  Result<Expression> whole(bool wants_condition) {
    Expression expression = disjunction();
    if (token().kind != Token::Kind::end) report_rest();
    if (wants_condition) {
      if (!expression.is_condition() && !expression.is_column())
        refuse("Expected a condition, not a number: compare the number with something", 0,
               mistake::kExpectsCondition);
      expression = condition(std::move(expression), 0);
    } else if (expression.is_condition()) {
      refuse("Expected a number, not a condition: write if(condition, 1, 0) to get a number", 0,
             mistake::kExpectsNumber);
    } else {
      expression = numeric(std::move(expression), 0);
    }
    if (problem()) return tl::unexpected(*problem());
    return expression;
  }

 private:
  Expression refuse(const std::string& what, std::optional<std::size_t> at = {},
                    std::string_view reason = mistake::kSyntax) {
    report(what, at, reason);
    return {};
  }

  Expression refuse_part(const std::string& what, Expression::Position part,
                         std::string_view reason, std::vector<std::string> suggestions = {}) {
    report_part(what, part, reason, std::move(suggestions));
    return {};
  }

  // --- grammar; each level parses operators of higher precedence first

  Expression disjunction() {
    const Nesting nesting(*this);
    Expression left = conjunction();
    while (is("or")) left = join(Op::any, std::move(left), [&] { return conjunction(); });
    return left;
  }

  Expression conjunction() {
    Expression left = negation();
    while (is("and")) left = join(Op::all, std::move(left), [&] { return negation(); });
    return left;
  }

  Expression negation() {
    const Nesting nesting(*this);
    if (!is("not")) return comparison();
    const auto at = token().at;
    advance();
    Expression part = negation();
    return make(Op::negation, at, condition(std::move(part), at));
  }

  Expression comparison() {
    const auto at = token().at;
    Expression left = sum();
    if (const Operator* row = operator_here(Form::comparison)) {
      advance();
      const auto right_at = token().at;
      Expression right = sum();
      if (operator_here(Form::comparison))
        refuse("A comparison has two sides only; join comparisons with 'and'");
      return compare(row->op, std::move(left), at, std::move(right), right_at);
    }
    if (is("is")) return null_test(value(std::move(left), at), at);
    const bool negated = is("not");
    if (!negated && !is("between") && !is("in") && !is("like")) return left;
    left = value(std::move(left), at);
    if (negated) advance();
    Expression test =
        is("between") ? between(std::move(left), at)
        : is("in")    ? membership(left, at)
        : is("like")
            ? likeness(std::move(left), at)
            : refuse("Expected 'between', 'in' or 'like' instead of '" + token().text + "'");
    return negated ? make(Op::negation, at, std::move(test)) : test;
  }

  // Compares two numbers, texts or times, or a boolean column with a boolean.
  Expression compare(Op op, Expression left, std::size_t at, Expression right,
                     std::size_t right_at) {
    if (left.is_column() && right.op == Op::truth && (op == Op::equal || op == Op::not_equal)) {
      Expression holds = make(Op::holds, at, std::move(left));
      return (right.number == 1) == (op == Op::equal) ? holds
                                                      : make(Op::negation, at, std::move(holds));
    }
    left = value(std::move(left), at);
    right = value(std::move(right), right_at);
    const auto takes_text = [](const Expression& e) { return e.is_text() || e.is_column(); };
    if ((left.is_text() && !takes_text(right)) || (right.is_text() && !takes_text(left)))
      refuse_part("A text can be compared with a column of texts only, not with a number",
                  left.is_text() ? left.position : right.position, mistake::kWrongType);
    return make(op, at, std::move(left), std::move(right));
  }

  // Parses the pattern after `like`.
  Expression likeness(Expression text, std::size_t at) {
    if (!text.is_text() && !text.is_column()) refuse("'like' works for texts only", at);
    advance();
    const auto pattern_at = token().at;
    Expression pattern = primary();
    if (!pattern.is_text())
      return refuse("Write the pattern in single quotes, as in like 'crack%'", pattern_at);
    const auto end = pattern.text.find_last_not_of('\\');
    if ((pattern.text.size() - (end == std::string::npos ? 0 : end + 1)) % 2 == 1)
      return refuse("A character must follow the \\ at the end of this pattern", pattern_at);
    return make(Op::like, at, std::move(text), std::move(pattern));
  }

  Expression null_test(Expression tested, std::size_t at) {
    advance();
    const bool negated = take("not");
    expect("null");
    Expression known = make(Op::known, at, std::move(tested));
    return negated ? known : make(Op::negation, at, std::move(known));
  }

  // Parses the limits after `between`. Both limits are included.
  Expression between(Expression middle, std::size_t at) {
    advance();
    const auto low_at = token().at;
    Expression low = sum();
    expect("and");
    const auto high_at = token().at;
    Expression high = sum();
    Expression above = compare(Op::greater_equal, again(middle), at, std::move(low), low_at);
    return make(Op::all, at, std::move(above),
                compare(Op::less_equal, std::move(middle), at, std::move(high), high_at));
  }

  Expression membership(const Expression& member, std::size_t at) {
    advance();
    expect("(");
    Expression any = make(Op::any, at);
    do {
      const auto each_at = token().at;
      any.parts.push_back(compare(Op::equal, again(member), at, disjunction(), each_at));
    } while (take(","));
    expect(")");
    return any;
  }

  Expression sum() { return chain(Form::sum, &Parser::product); }
  Expression product() { return chain(Form::product, &Parser::power); }

  Expression chain(Form form, Expression (Parser::*next)()) {
    const auto at = token().at;
    Expression left = (this->*next)();
    while (const Operator* row = operator_here(form))
      left = arithmetic(row->op, std::move(left), at, next);
    return left;
  }

  Expression power() {
    const auto at = token().at;
    Expression left = sign();
    const Operator* row = operator_here(Form::power);
    if (!row) return left;
    left = arithmetic(row->op, std::move(left), at, &Parser::sign);
    if (operator_here(Form::power)) refuse("Write parentheses around one of these powers");
    return left;
  }

  Expression arithmetic(Op op, Expression left, std::size_t at, Expression (Parser::*next)()) {
    left = numeric(std::move(left), at);
    advance();
    const auto right_at = token().at;
    Expression right = (this->*next)();
    return make(op, at, std::move(left), numeric(std::move(right), right_at));
  }

  Expression sign() {
    const Nesting nesting(*this);
    const auto at = token().at;
    const Operator* row = operator_here(Form::sign);
    if (!row) return primary();
    advance();
    Expression part = sign();
    return make(row->op, at, numeric(std::move(part), at));
  }

  Expression primary() {
    const Token token = this->token();
    switch (token.kind) {
      case Token::Kind::number: {
        advance();
        Expression expression;
        expression.number = token.number;
        expression.position.at = characters_before(token.at);
        return expression;
      }
      case Token::Kind::text: return literal();
      case Token::Kind::quoted: return named();
      case Token::Kind::word: break;
      default:
        if (take("(")) {
          Expression inside = disjunction();
          expect(")");
          return inside;
        }
        return refuse("Expected a number, " + std::string(what_names_are()) +
                      " or '(' instead of '" + token.text + "'");
    }
    if (is("true") || is("false")) {
      Expression truth;
      truth.op = Op::truth;
      truth.number = is("true") ? 1 : 0;
      advance();
      return truth;
    }
    if (is("case")) return cases();
    if (take("null")) return unknown();
    if (is_call()) return call();
    for (const std::string_view keyword : kKeywords)
      if (is(keyword))
        return refuse("Expected a number, " + std::string(what_names_are()) +
                      " or '(' instead of '" + token.text + "'");
    return named();
  }

  Expression call() {
    if (is("valid")) return validity();
    if (is("if")) return choice();
    if (is("reclass")) return reclass();
    if (is("date") || is("timestamp")) return time();
    if (is("interval")) return interval();
    if (is("within")) return within();
    if (is("hysteresis")) return hysteresis();
    for (const NamedSurfaceFunction& each : kSurfaceFunctions)
      if (is(each.name)) return surface_function(each);
    for (const Operator& each : operators()) {
      if (!is(each.name)) continue;
      switch (each.form) {
        case Form::number_function: return number_function(each);
        case Form::text_function: return text_function(each);
        case Form::time_function: return time_function(each);
        case Form::key_function: return key_function(each);
        default: break;
      }
    }
    if (is("buffer") && names_ == Names::layers)
      return refuse_part(
          "There is no function 'buffer'. Use within(condition, distance), which is true up to this "
          "distance",
          position(token().at, token_end()), mistake::kUnknownFunction, {"within"});
    return refuse_part("There is no function '" + token().text +
                           "'. Available are valid, if, reclass, " +
                           names_of(Form::number_function) + ", " + names_of(Form::text_function) +
                           ", date, timestamp, interval, " + names_of(Form::time_function) + ", " +
                           names_of(Form::key_function) + surface_functions(),
                       position(token().at, token_end()), mistake::kUnknownFunction,
                       closest_names(token().text, function_names()));
  }

  // Returns the end of the list of functions: ", distance, …".
  std::string surface_functions() const {
    if (names_ == Names::columns) return {};
    std::string names = ", within, hysteresis";
    for (const NamedSurfaceFunction& each : kSurfaceFunctions)
      names += ", " + std::string(each.name);
    return names;
  }

  std::vector<std::string> function_names() const {
    std::vector<std::string> names{"valid", "if", "reclass", "date", "timestamp", "interval"};
    for (const Operator& row : operators())
      if (row.form >= Form::number_function) names.emplace_back(row.name);
    if (names_ == Names::columns) return names;
    names.emplace_back("within");
    names.emplace_back("hysteresis");
    for (const NamedSurfaceFunction& each : kSurfaceFunctions) names.emplace_back(each.name);
    return names;
  }

  std::string_view what_names_are() const {
    return names_ == Names::layers ? "a layer" : "a column";
  }

  bool is_keyword() const {
    return std::ranges::any_of(kKeywords, [&](std::string_view word) { return is(word); });
  }

  // Parses the name of a layer or a column, or of a column of the record that a layer or another
  // column refers to.
  Expression named() {
    const auto at = token().at;
    const std::string what = "the name of " + std::string(what_names_are());
    if (is_keyword())
      return refuse("'" + token().text + "' is a keyword; to use it as " + what +
                    ", write it in double quotes");
    if (token().kind != Token::Kind::word && token().kind != Token::Kind::quoted)
      return refuse("Expected " + what + " instead of '" + token().text + "'");
    Expression expression;
    std::size_t end = token_end();  // of the name
    if (names_ == Names::layers) {
      expression.op = Op::layer;
      expression.name = token().text;
    } else {
      expression.op = Op::column;
      expression.path.push_back(token().text);
    }
    advance();
    while (take(".")) {
      if (token().kind != Token::Kind::word && token().kind != Token::Kind::quoted)
        return refuse("Expected the name of a column instead of '" + token().text + "'");
      expression.op = Op::column;
      expression.path.push_back(token().text);
      end = token_end();
      advance();
    }
    expression.position = position(at, end);
    return expression;
  }

  Expression validity() {
    if (names_ == Names::columns)
      return refuse("valid() works for layers only; for a column, write 'is not null'");
    advance();
    expect("(");
    Expression expression = named();
    if (expression.is_column())
      refuse("Expected the name of a layer; for a column, write 'is not null'");
    expression.op = Op::valid;
    expect(")");
    return expression;
  }

  // --- functions along the surface

  Expression within() {
    const auto at = token().at;
    return make(Op::known, at,
                surface_function({.op = Op::distance,
                                  .name = "within",
                                  .argument = NamedSurfaceFunction::Argument::condition}));
  }

  Expression hysteresis() {
    const auto at = token().at;
    return make(
        Op::known, at,
        along_surface(Op::hysteresis, NamedSurfaceFunction::Argument::number,
                      [this](Expression& function) {
                        Expression low;
                        low.number = threshold();
                        function.parts.push_back(std::move(low));
                        function.number = threshold();
                        if (function.number < function.parts.back().number)
                          refuse("The second threshold must not be lower than the first one");
                      }));
  }

  // Parses a comma and a number, which can be negative.
  double threshold() {
    if (!is(",")) refuse("Expected ',' and two thresholds, as in hysteresis(depth, 0.1, 0.3)");
    take(",");
    const double sign = take("-") ? -1 : 1;
    if (token().kind != Token::Kind::number) {
      refuse("Write the threshold as a number, such as 0.3");
      return 0;
    }
    const double number = token().number;
    advance();
    report_unit("layer");
    return sign * number;
  }

  Expression refuse_surface() {
    return refuse_part(
        "Records have no surface: use this function in a computed layer, and that layer in a "
        "condition over layers",
        position(token().at, token_end()), mistake::kComputedLayersOnly);
  }

  // Parses a function along the surface. `more` parses what follows its first argument.
  template <class More>
  Expression along_surface(Op op, NamedSurfaceFunction::Argument argument, More more) {
    const auto at = token().at;
    const auto name_end = token_end();
    if (names_ == Names::columns) return refuse_surface();
    advance();
    expect("(");
    Expression function = make(op, at, surface_argument(argument));
    more(function);
    expect(")");
    function.position = position(at, name_end);
    return function;
  }

  Expression surface_function(const NamedSurfaceFunction& named) {
    using Limit = NamedSurfaceFunction::Limit;
    const auto at = token().at;
    Expression function = along_surface(named.op, named.argument, [&](Expression& call) {
      call.number = std::numeric_limits<double>::infinity();
      if (named.limit == Limit::needed && !is(","))
        refuse("Expected ',' and " + std::string(named.limit_name == "area" ? "an " : "a ") +
               std::string(named.limit_name));
      if (named.limit != Limit::none && take(",")) call.number = limit(named);
      if (named.op == Op::hot_spot_chance) call.parts.push_back(permutations());
    });
    const bool cleans_condition = named.op != Op::distance && !function.parts.empty() &&
                                  function.parts.front().is_condition();
    return cleans_condition ? make(Op::known, at, std::move(function)) : function;
  }

  Expression surface_argument(NamedSurfaceFunction::Argument kind) {
    const auto at = token().at;
    Expression part = disjunction();
    if (kind == NamedSurfaceFunction::Argument::condition) return source(std::move(part), at);
    if (kind == NamedSurfaceFunction::Argument::either && part.is_condition()) return part;
    return numeric(std::move(part), at);
  }

  // A layer in place of a condition is true where the layer has a value.
  Expression source(Expression expression, std::size_t at) {
    if (expression.op == Op::layer) {
      expression.op = Op::valid;
      return expression;
    }
    return condition(std::move(expression), at);
  }

  double limit(const NamedSurfaceFunction& named) {
    if (is("-")) {
      refuse("The " + std::string(named.limit_name) +
             " must not be negative. Write a number such as 20");
      return 0;
    }
    if (token().kind != Token::Kind::number) {
      refuse("Write the " + std::string(named.limit_name) + " as a number, such as 20");
      return 0;
    }
    const double number = token().number;
    advance();
    report_unit(std::string(named.limit_unit));
    return number;
  }

  // Parses a comma and a number of permutations, or nothing.
  Expression permutations() {
    Expression number;
    number.number = kDefaultPermutations;
    if (!take(",")) return number;
    if (token().kind != Token::Kind::number || token().number < kMinPermutations ||
        token().number > kMaxPermutations || token().number != std::floor(token().number))
      return refuse("Write the number of permutations as a whole number from " +
                    std::to_string(kMinPermutations) + " to " + std::to_string(kMaxPermutations));
    number.number = token().number;
    advance();
    return number;
  }

  // --- texts and times

  Expression literal() {
    Expression expression;
    expression.op = Op::text;
    expression.position = position(token().at, token_end());
    expression.text = token().text;
    advance();
    return expression;
  }

  Expression quoted_time(bool may_be_open) {
    if (token().kind != Token::Kind::text)
      return refuse("Write the time in single quotes, as in date('2024-05-02')");
    if (!(may_be_open && token().text == "..") && !parse_edtf(token().text) &&
        !utc_timestamp(token().text))
      return refuse("'" + token().text.substr(0, 100) +
                    "' is not a date; write dates as 2024-05-02");
    return literal();
  }

  Expression time() {
    advance();
    expect("(");
    Expression expression = quoted_time(false);
    expect(")");
    return expression;
  }

  // Builds an interval in the EDTF notation.
  Expression interval() {
    advance();
    expect("(");
    Expression expression = quoted_time(true);
    expect(",");
    expression.text += "/" + quoted_time(true).text;
    expect(")");
    if (!problem() && !parse_edtf(expression.text))
      refuse("'" + expression.text.substr(0, 200) + "' is not an interval of days");
    return expression;
  }

  Expression text_function(const Operator& called) {
    const auto at = token().at;
    advance();
    expect("(");
    const auto part_at = token().at;
    Expression part = textual(disjunction(), part_at);
    expect(")");
    return make(called.op, at, std::move(part));
  }

  Expression time_function(const Operator& called) {
    const auto at = token().at;
    advance();
    expect("(");
    const auto first_at = token().at;
    Expression first = textual(disjunction(), first_at);
    expect(",");
    const auto second_at = token().at;
    Expression second = textual(disjunction(), second_at);
    expect(")");
    return make(called.op, at, std::move(first), std::move(second));
  }

  Expression key_function(const Operator& called) {
    const auto at = token().at;
    advance();
    expect("(");
    Expression relation = named();
    if (!relation.is_column()) refuse("Expected a column of keys here", at);
    expect(",");
    Expression keys = make(Op::keys, token().at);
    expect("(");
    do keys.parts.push_back(argument());
    while (take(","));
    expect(")");
    expect(")");
    return make(called.op, at, std::move(relation), std::move(keys));
  }

  // --- choices

  Expression choice() {
    const auto at = token().at;
    advance();
    expect("(");
    const auto condition_at = token().at;
    Expression when = condition(disjunction(), condition_at);
    expect(",");
    Expression then = argument();
    expect(",");
    Expression otherwise = argument();
    expect(")");
    return make(Op::choose, at, std::move(when), std::move(then), std::move(otherwise));
  }

  static Expression unknown() {
    Expression number;
    number.number = std::numeric_limits<double>::quiet_NaN();
    return number;
  }

  // Parses `case when … then … else … end` as a chain of choices.
  Expression cases() {
    const auto at = token().at;
    advance();
    std::vector<std::pair<Expression, Expression>> branches;
    if (!is("when")) return refuse("Expected 'when' instead of '" + token().text + "'");
    while (take("when")) {
      const auto condition_at = token().at;
      Expression when = condition(disjunction(), condition_at);
      expect("then");
      branches.emplace_back(std::move(when), argument());
    }
    Expression chain = take("else") ? argument() : unknown();
    expect("end");
    for (auto branch = branches.rbegin(); branch != branches.rend(); ++branch)
      chain = make(Op::choose, at, std::move(branch->first), std::move(branch->second),
                   std::move(chain));
    return chain;
  }

  // Parses a table of limits. Each value applies from its limit up to the next one. The value
  // before the first limit applies below it.
  Expression reclass() {
    const auto at = token().at;
    advance();
    expect("(");
    const Expression number = argument();
    expect(",");
    Expression chain = argument();
    if (!is(",")) refuse("Expected a limit and the value that applies from there on");
    while (take(",")) {
      Expression above = make(Op::greater_equal, at, again(number), argument());
      expect(",");
      chain = make(Op::choose, at, std::move(above), argument(), std::move(chain));
    }
    expect(")");
    return chain;
  }

  Expression number_function(const Operator& called) {
    const auto at = token().at;
    advance();
    expect("(");
    Expression expression = make(called.op, at, argument());
    while (expression.parts.size() < called.max_operands && take(","))
      expression.parts.push_back(argument());
    if (expression.parts.size() < called.min_operands) refuse("Expected at least two numbers");
    expect(")");
    return expression;
  }

  Expression argument() {
    const auto at = token().at;
    return numeric(disjunction(), at);
  }

  // --- types; the types of columns are not known here

  Expression condition(Expression expression, std::size_t at) {
    if (expression.is_column()) return make(Op::holds, at, std::move(expression));
    if (!expression.is_condition())
      refuse("Expected a condition, not a number: compare the number with something", at,
             mistake::kExpectsCondition);
    return expression;
  }
  Expression value(Expression expression, std::size_t at) {
    if (expression.is_condition())
      refuse("Expected a number here, not a condition", at, mistake::kExpectsNumber);
    return expression;
  }
  Expression numeric(Expression expression, std::size_t at) {
    if (expression.is_text()) refuse("Expected a number here, not a text", at, mistake::kWrongType);
    return value(std::move(expression), at);
  }
  Expression textual(Expression expression, std::size_t at) {
    if (!expression.is_text() && !expression.is_column())
      refuse("Expected a text or a column here", at, mistake::kWrongType);
    return expression;
  }

  template <class Next>
  Expression join(Op op, Expression left, Next next) {
    const auto at = token().at;
    left = condition(std::move(left), at);
    advance();
    const auto right_at = token().at;
    Expression right = condition(next(), right_at);
    if (left.op != op) return make(op, at, std::move(left), std::move(right));
    left.parts.push_back(std::move(right));
    return left;
  }

  // Copies an expression for a second use. The total is limited, because results must not grow
  // exponentially.
  Expression again(const Expression& expression) {
    repeated_ += size_of(expression);
    if (repeated_ > kMaxExpressionLength)
      return refuse("This expression has too many parts", {}, mistake::kTooLarge);
    return expression;
  }

  static std::size_t size_of(const Expression& expression) {
    std::size_t size = 1;
    for (const Expression& part : expression.parts) size += size_of(part);
    return size;
  }

  template <class... Parts>
  Expression make(Op op, std::size_t at, Parts... parts) {
    Expression expression;
    expression.op = op;
    expression.position.at = characters_before(at);
    (expression.parts.push_back(std::move(parts)), ...);
    // The limit protects the stack: a + b + c + … nests to the left, and evaluation and destruction
    // are recursive.
    if (depth_of(expression) > kMaxExpressionDepth)
      refuse("This expression is nested too deeply", at, mistake::kTooLarge);
    return expression;
  }

  static int depth_of(const Expression& expression) {
    int deepest = 0;
    for (const Expression& part : expression.parts) deepest = std::max(deepest, depth_of(part));
    return deepest + 1;
  }

  // Counts the nesting levels, because recursion must have a limit.
  struct Nesting {
    explicit Nesting(Parser& owner) : parser(owner) {
      if (++parser.depth_ > 3 * kMaxExpressionDepth)
        parser.refuse("This expression is nested too deeply", {}, mistake::kTooLarge);
    }
    ~Nesting() { --parser.depth_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;
    Parser& parser;
  };

  const Names names_;
  int depth_ = 0;
  std::size_t repeated_ = 0;
};

Result<Expression> parse(std::string_view text, const std::string& field, Names names,
                         bool wants_condition) {
  if (text.size() > kMaxExpressionLength)
    return fail(
        ErrorCode::invalid, "Expression too long",
        "An expression can have at most " + std::to_string(kMaxExpressionLength) + " characters.",
        field);
  return Parser(text, field, names).whole(wants_condition);
}

}  // namespace

Result<Expression> parse_condition(std::string_view text, const std::string& field, Names names) {
  return parse(text, field, names, true);
}
Result<Expression> parse_number(std::string_view text, const std::string& field, Names names) {
  return parse(text, field, names, false);
}

std::string name_in_expression(const std::string& slug) {
  const bool is_plain = !slug.empty() && begins_name(slug.front()) &&
                        std::ranges::find(kKeywords, slug) == kKeywords.end();
  return is_plain ? slug : '"' + slug + '"';
}

std::string text_in_expression(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace strata::query
