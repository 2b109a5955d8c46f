#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

// A pattern for file names that describe the content of the file, such as "{code}_{view}_{n}.jpg".
// A `{word}` matches one or more bytes. The text between words matches itself, without regard to
// the case of A to Z.
class NamePattern {
 public:
  static constexpr std::size_t kMaxWords = 8;

  // Returns an `invalid` error at `field` for a pattern without a word, a repeated word, two words
  // without text between them, or unbalanced braces.
  static Result<NamePattern> parse(std::string_view text, const std::string& field);

  bool has(std::string_view word) const;

  // Returns the words of a name, or nullopt if the name does not match. If a name can match in
  // several ways, the part for `word` is the longest known word. From left to right, each of
  // the other words is as short as possible.
  struct Reading {
    std::map<std::string, std::string> words;
    bool is_known = false;
  };
  template <class IsKnown>
  std::optional<Reading> read(std::string_view name, std::string_view word,
                              IsKnown&& is_known) const {
    for (const bool only_known : {true, false})
      for (const Span& span : spans(name, word))
        if (!only_known || is_known(name.substr(span.begin, span.end - span.begin)))
          return Reading{words_around(name, word, span), only_known};
    return std::nullopt;
  }

 private:
  struct Part {
    bool is_word = false;
    std::string text;  // the word's name, or the literal text
  };
  struct Span {
    std::size_t begin = 0, end = 0;
  };
  // Returns the possible positions of the word, the longest first.
  std::vector<Span> spans(std::string_view name, std::string_view word) const;
  std::map<std::string, std::string> words_around(std::string_view name, std::string_view word,
                                                  Span span) const;
  // Returns a table with a row for each part and the end, and a column for each position in the
  // name. An entry is true if the parts from there to `last` match the rest of the name.
  std::vector<std::vector<bool>> fits(std::string_view name, std::size_t first,
                                      std::size_t last) const;
  // Returns where the parts before `last` can end if they match from the beginning of the name.
  std::vector<bool> reached(std::string_view name, std::size_t last) const;

  std::vector<Part> parts_;
};

// Normalizes a value as users write it in file names: lower case, without spaces, hyphens and
// underscores.
std::string loose_name(std::string_view text);

}  // namespace strata
