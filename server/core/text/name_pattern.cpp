#include "core/text/name_pattern.h"

#include <algorithm>

namespace strata {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool stands_at(std::string_view name, std::size_t at, std::string_view text) {
  return name.size() - at >= text.size() &&
         std::equal(text.begin(), text.end(), name.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char a, char b) { return lower(a) == lower(b); });
}

}  // namespace

Result<NamePattern> NamePattern::parse(std::string_view text, const std::string& field) {
  const auto wrong = [&](const std::string& what) {
    return fail(ErrorCode::invalid, "Invalid pattern",
                what + " Write a pattern such as {code}_{view}_{n}.jpg.", field);
  };
  NamePattern pattern;
  std::size_t words = 0;
  while (!text.empty()) {
    const bool is_word = text.front() == '{';
    const std::size_t end =
        is_word ? text.find('}') : std::min(text.find_first_of("{}"), text.size());
    if (end == std::string_view::npos || (!is_word && end == 0))
      return wrong("The braces do not match.");
    const std::string part(text.substr(is_word ? 1 : 0, is_word ? end - 1 : end));
    text.remove_prefix(end + (is_word ? 1 : 0));
    if (is_word) {
      if (part.empty() || part.find('{') != std::string::npos)
        return wrong("The pattern needs a word between braces.");
      if (pattern.has(part)) return wrong("`{" + part + "}` appears in the pattern twice.");
      if (!pattern.parts_.empty() && pattern.parts_.back().is_word)
        return wrong("The pattern needs text between `{" + pattern.parts_.back().text +
                     "}` and `{" + part + "}`.");
      ++words;
    }
    pattern.parts_.push_back({is_word, part});
  }
  if (words == 0) return wrong("The pattern contains no word in braces.");
  if (words > kMaxWords)
    return wrong("The pattern has more than " + std::to_string(kMaxWords) + " words.");
  return pattern;
}

bool NamePattern::has(std::string_view word) const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [&](const Part& part) { return part.is_word && part.text == word; });
}

std::vector<std::vector<bool>> NamePattern::fits(std::string_view name, std::size_t first,
                                                 std::size_t last) const {
  std::vector<std::vector<bool>> can(parts_.size() + 1, std::vector<bool>(name.size() + 1, false));
  can[last][name.size()] = true;
  for (std::size_t p = last; p-- > first;) {
    bool later = false;  // the remaining parts match from a later position
    for (std::size_t at = name.size() + 1; at-- > 0;) {
      can[p][at] = parts_[p].is_word ? later
                                     : stands_at(name, at, parts_[p].text) &&
                                           can[p + 1][at + parts_[p].text.size()];
      later = later || can[p + 1][at];
    }
  }
  return can;
}

std::vector<bool> NamePattern::reached(std::string_view name, std::size_t last) const {
  std::vector<bool> ends(name.size() + 1, false);
  ends[0] = true;
  for (std::size_t p = 0; p < last; ++p) {
    std::vector<bool> next(name.size() + 1, false);
    bool earlier = false;  // the earlier parts end at an earlier position
    for (std::size_t at = 0; at <= name.size(); ++at) {
      if (parts_[p].is_word)
        next[at] = earlier;
      else if (ends[at] && stands_at(name, at, parts_[p].text))
        next[at + parts_[p].text.size()] = true;
      earlier = earlier || ends[at];
    }
    ends = std::move(next);
  }
  return ends;
}

std::vector<NamePattern::Span> NamePattern::spans(std::string_view name,
                                                  std::string_view word) const {
  std::size_t at = 0;
  while (!(parts_[at].is_word && parts_[at].text == word)) ++at;
  const auto behind = fits(name, at + 1, parts_.size());
  const auto before = reached(name, at);
  std::vector<Span> found;
  for (std::size_t begin = 0; begin < name.size(); ++begin) {
    if (!before[begin]) continue;
    for (std::size_t end = begin + 1; end <= name.size(); ++end)
      if (behind[at + 1][end]) found.push_back({begin, end});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Span& a, const Span& b) { return a.end - a.begin > b.end - b.begin; });
  return found;
}

std::map<std::string, std::string> NamePattern::words_around(std::string_view name,
                                                             std::string_view word,
                                                             Span span) const {
  std::map<std::string, std::string> words;
  std::size_t at = 0;
  while (!(parts_[at].is_word && parts_[at].text == word)) ++at;
  words[parts_[at].text] = name.substr(span.begin, span.end - span.begin);
  const auto take = [&](std::string_view part_of_name, std::size_t first, std::size_t last) {
    const auto can = fits(part_of_name, first, last);
    std::size_t place = 0;
    for (std::size_t p = first; p < last; ++p) {
      std::size_t end = place + (parts_[p].is_word ? 1 : parts_[p].text.size());
      while (!can[p + 1][end]) ++end;
      if (parts_[p].is_word) words[parts_[p].text] = part_of_name.substr(place, end - place);
      place = end;
    }
  };
  take(name.substr(0, span.begin), 0, at);
  take(name.substr(span.end), at + 1, parts_.size());
  return words;
}

std::string loose_name(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (c != ' ' && c != '-' && c != '_') out += lower(c);
  return out;
}

}  // namespace strata
