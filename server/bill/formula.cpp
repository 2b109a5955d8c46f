#include "bill/formula.h"

#include "core/text/utf8.h"

namespace strata::bill {
namespace {

constexpr int kMaxDepth = 50;
constexpr int kMaxPower = 9;

class FormulaReader {
 public:
  explicit FormulaReader(std::string_view text) : text_(text) {}

  std::optional<ExactNumber> read() {
    auto value = sum(0);
    if (!value) return std::nullopt;
    take("=");
    skip_spaces();
    if (at_ < text_.size()) return std::nullopt;
    return value;
  }
  std::size_t at() const { return at_; }

 private:
  std::optional<ExactNumber> sum(int depth) {
    auto value = product(depth);
    while (value) {
      const bool is_minus = take("-") || take("−") || take("–");
      if (!is_minus && !take("+")) break;
      const auto next = product(depth);
      if (!next) return std::nullopt;
      value = is_minus ? *value - *next : *value + *next;
    }
    return value;
  }

  std::optional<ExactNumber> product(int depth) {
    auto value = signed_power(depth);
    while (value) {
      const bool is_times = take("*") || take("x") || take("X") || take("×") || take("·");
      if (!is_times && !take("/") && !take(":") && !take("÷")) break;
      const auto next = signed_power(depth);
      if (!next) return std::nullopt;
      value = is_times ? *value * *next : *value / *next;
    }
    return value;
  }

  std::optional<ExactNumber> signed_power(int depth) {
    if (depth > kMaxDepth) return std::nullopt;
    if (take("-") || take("−")) {
      const auto value = signed_power(depth + 1);
      return value ? std::optional(-*value) : std::nullopt;
    }
    const auto base = primary(depth);
    if (!base) return std::nullopt;
    int exponent = 1;
    if (take("²")) {
      exponent = 2;
    } else if (take("³")) {
      exponent = 3;
    } else if (take("^")) {
      skip_spaces();
      if (at_ >= text_.size() || text_[at_] < '0' || text_[at_] > '0' + kMaxPower)
        return std::nullopt;
      exponent = text_[at_++] - '0';
    }
    ExactNumber power(1);
    for (int i = 0; i < exponent; ++i) power = power * *base;
    return power;
  }

  std::optional<ExactNumber> primary(int depth) {
    if (take("(")) {
      const auto value = sum(depth + 1);
      return value && take(")") ? value : std::nullopt;
    }
    skip_spaces();
    const std::size_t end = std::min(text_.find_first_not_of("0123456789.,", at_), text_.size());
    const auto number = ExactNumber::parse(text_.substr(at_, end - at_));
    if (number) at_ = end;
    return number;
  }

  bool take(std::string_view symbol) {
    skip_spaces();
    if (!text_.substr(at_).starts_with(symbol)) return false;
    at_ += symbol.size();
    return true;
  }
  void skip_spaces() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Result<ExactNumber> compute_formula(std::string_view text, const std::string& field) {
  if (text.size() > kMaxFormula)
    return fail(ErrorCode::invalid, "Formula too long",
                "A formula can have at most " + std::to_string(kMaxFormula) +
                    " bytes. Divide it into several hand measurements.",
                field);
  FormulaReader reader(text);
  const auto value = reader.read();
  if (!value) {
    const std::size_t place = character_count(text.substr(0, reader.at()));
    auto problem = fail(ErrorCode::invalid, "Formula not readable",
                        "The formula has a mistake after character " + std::to_string(place) +
                            ". Use numbers, + - * / ^ and parentheses, as in `2 * 1,20 * 0,85`.",
                        field);
    problem.value().offset = place;
    return problem;
  }
  if (!value->is_valid())
    return fail(ErrorCode::invalid, "Formula has no exact result",
                "The formula divides by zero, or its result is too large or has too many "
                "different divisors. Divide it into several hand measurements.",
                field);
  return *value;
}

}  // namespace strata::bill
