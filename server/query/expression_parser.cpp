#include "query/expression_parser.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace strata::query {
namespace {

using Op = Expression::Op;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

struct Token {
  enum class Kind { end, number, word, quoted, symbol };
  Kind kind = Kind::end;
  std::size_t at = 0;  // position in the text
  std::string text;    // words in lower case
  double number = 0;
};

constexpr std::array kKeywords{"and",  "or",   "not", "true", "false",   "valid", "if",   "case", "when",
                               "then", "else", "end", "is",   "between", "in",    "null", "div"};

// Of numbers; `least` and `greatest` take two or more.
struct Function {
  std::string_view name;
  Op op;
};
constexpr std::array kFunctions{
    Function{"min", Op::least},         Function{"max", Op::greatest},    Function{"abs", Op::absolute},
    Function{"sqrt", Op::square_root},  Function{"exp", Op::exponential}, Function{"ln", Op::natural_log},
    Function{"log10", Op::decimal_log}, Function{"floor", Op::floor},     Function{"ceil", Op::ceiling},
    Function{"round", Op::round},       Function{"sin", Op::sine},        Function{"cos", Op::cosine},
    Function{"tan", Op::tangent},       Function{"asin", Op::arc_sine},   Function{"acos", Op::arc_cosine},
    Function{"atan", Op::arc_tangent},  Function{"radians", Op::radians}, Function{"degrees", Op::degrees}};

struct Comparison {
  std::string_view symbol;
  Op op;
};
constexpr std::array kComparisons{Comparison{"=", Op::equal},      Comparison{"==", Op::equal},
                                  Comparison{"<>", Op::not_equal}, Comparison{"!=", Op::not_equal},
                                  Comparison{"<", Op::less},       Comparison{"<=", Op::less_equal},
                                  Comparison{">", Op::greater},    Comparison{">=", Op::greater_equal}};

// Recursive descent. The first refusal is kept and ends the text, so that every level returns, whatever it holds by then.
class Parser {
 public:
  Parser(std::string_view text, const std::string& field) : text_(text), field_(field) { advance(); }

  Result<Expression> whole(bool wants_condition) {
    Expression expression = disjunction();
    if (token_.kind != Token::Kind::end) refuse("'" + token_.text + "' was not expected here");
    if (wants_condition && !expression.is_condition())
      refuse("A condition is wanted, not a number: compare it with something", 0);
    if (!wants_condition && expression.is_condition())
      refuse("A number is wanted, not a condition: if(condition, 1, 0) makes one of it", 0);
    if (problem_) return tl::unexpected(*problem_);
    return expression;
  }

 private:
  Expression refuse(const std::string& what, std::optional<std::size_t> at = {}) {
    if (!problem_)
      problem_ = Problem{422, "Expression not understood",
                         what + " (at character " + std::to_string(at.value_or(token_.at) + 1) + ").", field_};
    at_ = text_.size();
    token_ = Token{};
    return {};
  }

  // --- tokens

  void advance() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    token_ = Token{};
    token_.at = at_;
    if (at_ == text_.size()) {
      token_.text = "the end";
      return;
    }
    const char c = text_[at_];
    if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) return take_number();
    if (is_letter(c)) return take_word();
    if (c == '"') return take_quoted();
    take_symbol();
  }

  void take_number() {
    token_.kind = Token::Kind::number;
    const char* begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), token_.number);
    if (error != std::errc() || !std::isfinite(token_.number)) {
      refuse("This number is too large");
      return;
    }
    token_.text = std::string(begin, end);
    at_ += static_cast<std::size_t>(end - begin);
    if (at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '.'))
      refuse("A number ends here; a layer whose name begins with a digit stands in double quotes", at_);
  }

  void take_word() {
    token_.kind = Token::Kind::word;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      const bool hyphen = c == '-' && at_ + 1 < text_.size() && (is_letter(text_[at_ + 1]) || is_digit(text_[at_ + 1]));
      if (!is_letter(c) && !is_digit(c) && !hyphen) break;
      token_.text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
  }

  void take_quoted() {
    token_.kind = Token::Kind::quoted;
    const auto end = text_.find('"', at_ + 1);
    if (end == std::string_view::npos || end == at_ + 1) {
      refuse(end == at_ + 1 ? "A name is missing between the quotes" : "The double quote is never closed");
      return;
    }
    token_.text = std::string(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
  }

  void take_symbol() {
    token_.kind = Token::Kind::symbol;
    std::size_t length = 1;
    for (const Comparison& comparison : kComparisons)
      if (comparison.symbol.size() == 2 && text_.substr(at_, 2) == comparison.symbol) length = 2;
    token_.text = std::string(text_.substr(at_, length));
    at_ += length;
    if (length == 1 && std::string_view("()+-*/%^,<>=").find(token_.text) == std::string_view::npos)
      refuse("This character has no meaning in an expression");
  }

  bool is(std::string_view text) const {
    return (token_.kind == Token::Kind::word || token_.kind == Token::Kind::symbol) && token_.text == text;
  }
  bool take(std::string_view text) {
    if (!is(text)) return false;
    advance();
    return true;
  }
  void expect(std::string_view text) {
    if (!take(text)) refuse("Expected '" + std::string(text) + "' instead of '" + token_.text + "'");
  }

  // --- grammar; each level reads what binds more tightly

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
    const auto at = token_.at;
    advance();
    Expression part = negation();
    return make(Op::negation, at, condition(std::move(part), at));
  }

  Expression comparison() {
    const auto at = token_.at;
    Expression left = sum();
    for (const Comparison& each : kComparisons) {
      if (!is(each.symbol)) continue;
      left = numeric(std::move(left), at);
      advance();
      const auto right_at = token_.at;
      Expression right = numeric(sum(), right_at);
      for (const Comparison& next : kComparisons)
        if (is(next.symbol)) refuse("Only two numbers are compared at a time; join comparisons with 'and'");
      return make(each.op, at, std::move(left), std::move(right));
    }
    if (is("is")) return null_test(numeric(std::move(left), at), at);
    const bool negated = is("not");
    if (!negated && !is("between") && !is("in")) return left;
    left = numeric(std::move(left), at);
    if (negated) advance();
    Expression test = is("between") ? between(std::move(left), at)
                      : is("in")    ? membership(std::move(left), at)
                                    : refuse("Expected 'between' or 'in' instead of '" + token_.text + "'");
    return negated ? make(Op::negation, at, std::move(test)) : test;
  }

  Expression null_test(Expression number, std::size_t at) {
    advance();
    const bool negated = take("not");
    expect("null");
    Expression known = make(Op::known, at, std::move(number));
    return negated ? known : make(Op::negation, at, std::move(known));
  }

  // Both ends belong to it.
  Expression between(Expression number, std::size_t at) {
    advance();
    const auto low_at = token_.at;
    Expression low = numeric(sum(), low_at);
    expect("and");
    const auto high_at = token_.at;
    Expression high = numeric(sum(), high_at);
    Expression above = make(Op::greater_equal, at, number, std::move(low));
    return make(Op::all, at, std::move(above), make(Op::less_equal, at, std::move(number), std::move(high)));
  }

  Expression membership(Expression number, std::size_t at) {
    advance();
    expect("(");
    Expression any = make(Op::any, at);
    do any.parts.push_back(make(Op::equal, at, number, argument()));
    while (take(","));
    expect(")");
    return any;
  }

  Expression sum() {
    const auto at = token_.at;
    Expression left = product();
    while (is("+") || is("-"))
      left = arithmetic(is("+") ? Op::add : Op::subtract, std::move(left), at, &Parser::product);
    return left;
  }

  Expression product() {
    const auto at = token_.at;
    Expression left = power();
    for (;;) {
      const Op op = is("*") ? Op::multiply : is("/") ? Op::divide : is("%") ? Op::remainder : Op::whole_division;
      if (op == Op::whole_division && !is("div")) return left;
      left = arithmetic(op, std::move(left), at, &Parser::power);
    }
  }

  Expression power() {
    const auto at = token_.at;
    Expression left = sign();
    if (!is("^")) return left;
    left = arithmetic(Op::power, std::move(left), at, &Parser::sign);
    if (is("^")) refuse("Powers of powers need parentheses");
    return left;
  }

  Expression arithmetic(Op op, Expression left, std::size_t at, Expression (Parser::*next)()) {
    left = numeric(std::move(left), at);
    advance();
    const auto right_at = token_.at;
    Expression right = (this->*next)();
    return make(op, at, std::move(left), numeric(std::move(right), right_at));
  }

  Expression sign() {
    const Nesting nesting(*this);
    const auto at = token_.at;
    if (!take("-")) return primary();
    Expression part = sign();
    return make(Op::negate, at, numeric(std::move(part), at));
  }

  Expression primary() {
    const Token token = token_;
    switch (token.kind) {
      case Token::Kind::number: {
        advance();
        Expression expression;
        expression.number = token.number;
        return expression;
      }
      case Token::Kind::quoted: return layer();
      case Token::Kind::word: break;
      default:
        if (take("(")) {
          Expression inside = disjunction();
          expect(")");
          return inside;
        }
        return refuse("Expected a number, a layer or '(' instead of '" + token.text + "'");
    }
    if (is("true") || is("false")) {
      Expression truth;
      truth.op = Op::truth;
      truth.number = is("true") ? 1 : 0;
      advance();
      return truth;
    }
    if (is("valid")) return validity();
    if (is("if")) return choice();
    if (is("case")) return cases();
    if (take("null")) return unknown();
    for (const Function& each : kFunctions)
      if (is(each.name)) return function(each);
    for (const char* keyword : kKeywords)
      if (is(keyword)) return refuse("Expected a number, a layer or '(' instead of '" + token.text + "'");
    return layer();
  }

  Expression layer() {
    const auto is_word_of_language = [&] {
      return std::ranges::any_of(kKeywords, [&](const char* word) { return is(word); }) ||
             std::ranges::any_of(kFunctions, [&](const Function& each) { return is(each.name); });
    };
    if (token_.kind == Token::Kind::word && is_word_of_language())
      return refuse("'" + token_.text + "' is a word of the language; a layer of this name stands in double quotes");
    if (token_.kind != Token::Kind::word && token_.kind != Token::Kind::quoted)
      return refuse("Expected the name of a layer instead of '" + token_.text + "'");
    Expression expression;
    expression.op = Op::layer;
    expression.layer = token_.text;
    advance();
    if (is("(")) {
      std::string known = "valid, if";
      for (const Function& each : kFunctions) known += ", " + std::string(each.name);
      refuse("There is no function '" + expression.layer + "'; there are " + known);
    }
    return expression;
  }

  Expression validity() {
    advance();
    expect("(");
    Expression expression = layer();
    expression.op = Op::valid;
    expect(")");
    return expression;
  }

  Expression choice() {
    const auto at = token_.at;
    advance();
    expect("(");
    const auto condition_at = token_.at;
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

  // case when … then … else … end: choices in a chain.
  Expression cases() {
    const auto at = token_.at;
    advance();
    std::vector<std::pair<Expression, Expression>> branches;
    if (!is("when")) return refuse("Expected 'when' instead of '" + token_.text + "'");
    while (take("when")) {
      const auto condition_at = token_.at;
      Expression when = condition(disjunction(), condition_at);
      expect("then");
      branches.emplace_back(std::move(when), argument());
    }
    Expression chain = take("else") ? argument() : unknown();
    expect("end");
    for (auto branch = branches.rbegin(); branch != branches.rend(); ++branch)
      chain = make(Op::choose, at, std::move(branch->first), std::move(branch->second), std::move(chain));
    return chain;
  }

  Expression function(const Function& called) {
    const auto at = token_.at;
    advance();
    expect("(");
    Expression expression = make(called.op, at, argument());
    if (called.op == Op::least || called.op == Op::greatest) {
      if (!is(",")) refuse("At least two numbers are compared");
      while (take(",")) expression.parts.push_back(argument());
    }
    expect(")");
    return expression;
  }

  Expression argument() {
    const auto at = token_.at;
    return numeric(disjunction(), at);
  }

  // --- kinds

  Expression condition(Expression expression, std::size_t at) {
    if (!expression.is_condition()) refuse("A condition is wanted here, not a number: compare it with something", at);
    return expression;
  }
  Expression numeric(Expression expression, std::size_t at) {
    if (expression.is_condition()) refuse("A number is wanted here, not a condition", at);
    return expression;
  }

  template <class Next>
  Expression join(Op op, Expression left, Next next) {
    const auto at = token_.at;
    left = condition(std::move(left), at);
    advance();
    const auto right_at = token_.at;
    Expression right = condition(next(), right_at);
    if (left.op != op) return make(op, at, std::move(left), std::move(right));
    left.parts.push_back(std::move(right));
    return left;
  }

  template <class... Parts>
  Expression make(Op op, std::size_t at, Parts... parts) {
    Expression expression;
    expression.op = op;
    (expression.parts.push_back(std::move(parts)), ...);
    // Also a + b + c + … nests, to the left; and it is evaluated and destroyed by recursion.
    if (depth_of(expression) > kMaxExpressionDepth) refuse("This is nested too deeply", at);
    return expression;
  }

  static int depth_of(const Expression& expression) {
    int deepest = 0;
    for (const Expression& part : expression.parts) deepest = std::max(deepest, depth_of(part));
    return deepest + 1;
  }

  // Levels that can call themselves without end.
  struct Nesting {
    explicit Nesting(Parser& owner) : parser(owner) {
      if (++parser.depth_ > 3 * kMaxExpressionDepth) parser.refuse("This is nested too deeply");
    }
    ~Nesting() { --parser.depth_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;
    Parser& parser;
  };

  const std::string_view text_;
  const std::string& field_;
  std::size_t at_ = 0;
  Token token_;
  int depth_ = 0;
  std::optional<Problem> problem_;
};

Result<Expression> parse(std::string_view text, const std::string& field, bool wants_condition) {
  if (text.size() > kMaxExpressionLength)
    return fail(422, "Expression too long",
                "An expression has at most " + std::to_string(kMaxExpressionLength) + " characters.", field);
  return Parser(text, field).whole(wants_condition);
}

}  // namespace

Result<Expression> parse_condition(std::string_view text, const std::string& field) { return parse(text, field, true); }
Result<Expression> parse_number(std::string_view text, const std::string& field) { return parse(text, field, false); }

}  // namespace strata::query
