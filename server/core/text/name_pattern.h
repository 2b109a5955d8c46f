#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

// Names of files that say what is on them: "{code}_{view}_{n}.jpg". A `{word}` stands for one or
// more bytes, what is between the words for itself, whatever the case of A to Z.
class NamePattern {
 public:
  static constexpr std::size_t kMaxWords = 8;

  // `invalid` (`field`): no word, a word twice, two words without anything between them, braces
  // that do not fit.
  static Result<NamePattern> parse(std::string_view text, const std::string& field);

  bool has(std::string_view word) const;

  // What the words are in a name; nothing: it is not of the pattern. Where it can be read in
  // several ways, `word` is one of `known` (the longest), and the others are as short as they can
  // be from the left.
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
    std::string text;  // the word's name, or what stands for itself
  };
  struct Span {
    std::size_t begin = 0, end = 0;
  };
  // Where the word may stand, the longest first.
  std::vector<Span> spans(std::string_view name, std::string_view word) const;
  std::map<std::string, std::string> words_around(std::string_view name, std::string_view word,
                                                  Span span) const;
  // For each part, and for the end: can the parts from there on (up to `last`) be the name from
  // each place on?
  std::vector<std::vector<bool>> fits(std::string_view name, std::size_t first,
                                      std::size_t last) const;
  // Where the parts before `last` may end that begin with the name.
  std::vector<bool> reached(std::string_view name, std::size_t last) const;

  std::vector<Part> parts_;
};

// A value as people write it in names of files: lower case, without spaces, hyphens and
// underscores.
std::string loose_name(std::string_view text);

}  // namespace strata
