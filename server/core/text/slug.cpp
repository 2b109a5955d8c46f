#include "core/text/slug.h"

#include <algorithm>

namespace strata {

bool is_all_digits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::string make_slug(std::string_view name) {
  constexpr std::size_t kMaxLength = 48;
  std::string slug;
  for (char c : name) {
    if (slug.size() >= kMaxLength) break;
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
      slug += c;
    else if (!slug.empty() && slug.back() != '-')
      slug += '-';
  }
  while (!slug.empty() && slug.back() == '-') slug.pop_back();
  if (slug.empty()) return "n";
  return is_all_digits(slug) ? "n-" + slug : slug;
}

}  // namespace strata
