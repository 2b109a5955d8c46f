#include "expression/token_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/text/closest.h"
#include "core/text/utf8.h"

namespace strata::query {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// The words that can follow a number or a condition.
const std::vector<std::string> kJoiningWords{"and", "or", "not", "is", "between", "like", "div"};
// The units that users write after numbers. The inch is missing, because `in` is a keyword of the
// language.
constexpr std::array<std::string_view, 11> kUnits{"mm",  "cm", "m",  "km", "um",     "nm",
                                                  "deg", "g",  "kg", "ft", "percent"};

}  // namespace

bool begins_name(char c) { return is_letter(c); }

TokenReader::TokenReader(std::string_view text, const std::string& field)
    : text_(text), field_(field) {
  advance();
}

void TokenReader::report(const std::string& what, std::optional<std::size_t> at,
                         std::string_view reason) {
  const std::size_t begin = at.value_or(token_.at);
  report_part(what, position(begin, begin), reason);
}

void TokenReader::report_part(const std::string& what, Expression::Position part,
                              std::string_view reason, std::vector<std::string> suggestions) {
  if (!problem_) problem_ = expression_problem(what, part, field_, reason, std::move(suggestions));
  at_ = text_.size();
  token_ = Token{};
}

void TokenReader::syntax_error(const std::string& what, std::optional<std::size_t> at) {
  report(what, at, mistake::kSyntax);
}

void TokenReader::report_rest() {
  const std::string what = "'" + token_.text + "' was not expected here";
  const std::string word = token_.text;
  if (token_.kind != Token::Kind::word) {
    syntax_error(what);
    return;
  }
  if (report_unit("layer or column")) return;
  report_part(what, position(token_.at, at_), mistake::kSyntax, closest_names(word, kJoiningWords));
}

bool TokenReader::report_unit(const std::string& what) {
  if (number_end_ == 0 || token_.kind != Token::Kind::word ||
      std::ranges::find(kUnits, token_.text) == kUnits.end() ||
      !std::ranges::all_of(text_.substr(number_end_, token_.at - number_end_), is_space))
    return false;
  const std::string number(text_.substr(number_at_, number_end_ - number_at_));
  report_part("Write numbers without a unit. '" + number + "' has the unit of the " + what,
              position(number_at_, at_), mistake::kUnit, {number});
  return true;
}

Expression::Position TokenReader::position(std::size_t begin_byte, std::size_t end_byte) const {
  const std::size_t at = characters_before(begin_byte);
  return {at, characters_before(end_byte) - at};
}

std::size_t TokenReader::characters_before(std::size_t byte) const {
  return static_cast<std::size_t>(std::ranges::count_if(text_.substr(0, byte), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u;
  }));
}

void TokenReader::advance() {
  while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  token_ = Token{};
  token_.at = at_;
  if (at_ == text_.size()) {
    token_.text = "the end";
    return;
  }
  const char c = text_[at_];
  if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1])))
    return take_number();
  if (is_letter(c)) return take_word();
  if (c == '"') return take_quoted();
  if (c == '\'') return take_text();
  take_symbol();
}

void TokenReader::take_number() {
  token_.kind = Token::Kind::number;
  const char* begin = text_.data() + at_;
  const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), token_.number);
  if (error != std::errc() || !std::isfinite(token_.number)) {
    syntax_error("This number is too large");
    return;
  }
  token_.text = std::string(begin, end);
  number_at_ = at_;
  at_ += static_cast<std::size_t>(end - begin);
  number_end_ = at_;
  if (at_ < text_.size() && is_letter(text_[at_])) {
    std::size_t word_end = at_;
    while (word_end < text_.size() && (is_letter(text_[word_end]) || is_digit(text_[word_end])))
      ++word_end;
    if (std::ranges::find(kUnits, text_.substr(at_, word_end - at_)) != kUnits.end()) {
      report_part("A number ends here. Write numbers without a unit: '" + token_.text +
                      "' has the unit of the layer or column. A name that begins with a digit "
                      "needs double quotes",
                  position(number_at_, word_end), mistake::kUnit, {token_.text});
      return;
    }
  }
  if (at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '.'))
    syntax_error(
        "A number ends here; write the name of a layer in double quotes if it begins "
        "with a digit",
        at_);
}

void TokenReader::take_word() {
  token_.kind = Token::Kind::word;
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    const bool hyphen = c == '-' && at_ + 1 < text_.size() &&
                        (is_letter(text_[at_ + 1]) || is_digit(text_[at_ + 1]));
    if (!is_letter(c) && !is_digit(c) && !hyphen) break;
    token_.text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
}

void TokenReader::take_quoted() {
  token_.kind = Token::Kind::quoted;
  const auto end = text_.find('"', at_ + 1);
  if (end == std::string_view::npos || end == at_ + 1) {
    syntax_error(end == at_ + 1 ? "A name is missing between the quotes"
                                : "The closing double quote is missing");
    return;
  }
  token_.text = std::string(text_.substr(at_ + 1, end - at_ - 1));
  at_ = end + 1;
}

// A quote inside the text is written twice.
void TokenReader::take_text() {
  token_.kind = Token::Kind::text;
  std::size_t at = at_ + 1;
  for (;; ++at) {
    if (at == text_.size()) {
      syntax_error("The closing quote is missing");
      return;
    }
    if (text_[at] == '\'') {
      if (at + 1 == text_.size() || text_[at + 1] != '\'') break;
      ++at;
    }
    token_.text += text_[at];
  }
  if (!is_utf8(token_.text) || token_.text.find('\0') != std::string::npos) {
    syntax_error("This text is not encoded as UTF-8");
    return;
  }
  at_ = at + 1;
}

void TokenReader::take_symbol() {
  token_.kind = Token::Kind::symbol;
  const auto is_symbol = [](std::string_view text) {
    return text == "(" || text == ")" || text == "," || text == "." ||
           std::ranges::any_of(operators(),
                               [&](const Operator& row) { return row.is_called(text); });
  };
  const std::size_t length =
      is_symbol(text_.substr(at_, 2)) ? std::min<std::size_t>(2, text_.size() - at_) : 1;
  token_.text = std::string(text_.substr(at_, length));
  at_ += length;
  if (!is_symbol(token_.text)) syntax_error("This character has no meaning in an expression");
}

bool TokenReader::is(std::string_view text) const {
  return (token_.kind == Token::Kind::word || token_.kind == Token::Kind::symbol) &&
         token_.text == text;
}

bool TokenReader::take(std::string_view text) {
  if (!is(text)) return false;
  advance();
  return true;
}

bool TokenReader::is_call() const {
  if (token_.kind != Token::Kind::word) return false;
  std::size_t next = at_;
  while (next < text_.size() && is_space(text_[next])) ++next;
  return next < text_.size() && text_[next] == '(';
}

const Operator* TokenReader::operator_here(Operator::Form form) const {
  const auto row = std::ranges::find_if(operators(), [&](const Operator& each) {
    return each.form == form && (is(each.name) || (!each.alias.empty() && is(each.alias)));
  });
  return row == operators().end() ? nullptr : &*row;
}

void TokenReader::expect(std::string_view text) {
  if (!take(text))
    syntax_error("Expected '" + std::string(text) + "' instead of '" + token_.text + "'");
}

}  // namespace strata::query
