#include "domain/tables/term.h"

#include <algorithm>

namespace strata {
namespace {

constexpr std::string_view kLabel = "label-";

}  // namespace

std::string label_slug(const std::string& language) { return std::string(kLabel) + language; }

std::optional<std::string> label_language(std::string_view slug) {
  if (!slug.starts_with(kLabel)) return std::nullopt;
  const std::string_view tag = slug.substr(kLabel.size());
  // As in Turtle, the first part has only letters. Otherwise, an exported list could not be read
  // again.
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789-";
  constexpr std::string_view kLetters = kAllowed.substr(0, 26);
  const std::string_view first = tag.substr(0, tag.find('-'));
  const bool is_tag = !first.empty() && tag.size() <= 35 && tag.back() != '-' &&
                      tag.find("--") == std::string_view::npos &&
                      first.find_first_not_of(kLetters) == std::string_view::npos &&
                      tag.find_first_not_of(kAllowed) == std::string_view::npos;
  if (!is_tag) return std::nullopt;
  return std::string(tag);
}

std::optional<std::string> clean_color(std::string_view text) {
  std::string color(text);
  std::transform(color.begin(), color.end(), color.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (color.size() != 4 && color.size() != 7) return std::nullopt;
  if (color[0] != '#' || color.find_first_not_of("0123456789abcdef", 1) != std::string::npos)
    return std::nullopt;
  if (color.size() == 7) return color;
  std::string whole = "#";
  for (const char digit : color.substr(1)) whole.append(2, digit);
  return whole;
}

Result<void> check_term(Term& term) {
  if (term.code.empty() || term.code.size() > kMaxCodeLength)
    return fail(
        ErrorCode::invalid, "Invalid code",
        "The code of a term must be 1 to " + std::to_string(kMaxCodeLength) + " bytes long.",
        "code");
  if (!term.color.empty()) {
    const auto color = clean_color(term.color);
    if (!color)
      return fail(ErrorCode::invalid, "Invalid color",
                  "Write a color as #rrggbb, for example #c04020.", "color");
    term.color = *color;
  }
  if (!term.pattern.empty() && std::find(std::begin(kTermPatterns), std::end(kTermPatterns),
                                         term.pattern) == std::end(kTermPatterns))
    return fail(ErrorCode::invalid, "Invalid pattern",
                "The pattern must be solid, hatch, dots or outline.", "pattern");
  return {};
}

}  // namespace strata
