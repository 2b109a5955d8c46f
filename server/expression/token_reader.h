#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "expression/operators.h"

namespace strata::query {

struct Token {
  enum class Kind { end, number, word, quoted, text, symbol };
  Kind kind = Kind::end;
  std::size_t at = 0;  // position in the text
  std::string text;    // words are in lowercase
  double number = 0;
};

bool begins_name(char c);  // a letter or an underscore

// Divides the text of an expression into tokens, with one token of lookahead. Keeps the first error
// and then moves to the end of the text, so that its user needs no checks.
class TokenReader {
 public:
  // `text` and `field` must outlive the reader.
  TokenReader(std::string_view text, const std::string& field);

  const std::optional<Error>& problem() const { return problem_; }

 protected:
  const Token& token() const { return token_; }
  std::size_t token_end() const { return at_; }  // in bytes
  void advance();

  bool is(std::string_view text) const;  // for words and symbols
  bool take(std::string_view text);      // advances if `is(text)`
  void expect(std::string_view text);    // refuses the token if it is another one
  bool is_call() const;                  // a word before "("
  const Operator* operator_here(Operator::Form form) const;  // null: no such operator

  // Reports an error at byte `at`, by default at the token.
  void report(const std::string& what, std::optional<std::size_t> at, std::string_view reason);
  void report_part(const std::string& what, Expression::Position part, std::string_view reason,
                   std::vector<std::string> suggestions = {});
  // Reports the token as text after a complete expression, perhaps a unit or a misspelled word.
  void report_rest();
  // Reports a unit after the last number, and returns true if there is one. `what` has the unit
  // that the number has.
  bool report_unit(const std::string& what);

  // Positions are characters, because users see them.
  Expression::Position position(std::size_t begin_byte, std::size_t end_byte) const;
  std::size_t characters_before(std::size_t byte) const;

 private:
  void take_number();
  void take_word();
  void take_quoted();
  void take_text();
  void take_symbol();
  void syntax_error(const std::string& what, std::optional<std::size_t> at = {});

  const std::string_view text_;
  const std::string& field_;
  std::size_t at_ = 0;
  Token token_;
  std::size_t number_at_ = 0, number_end_ = 0;  // bytes of the last number
  std::optional<Error> problem_;
};

}  // namespace strata::query
