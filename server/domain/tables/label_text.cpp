#include "domain/tables/label_text.h"

#include <algorithm>

namespace strata {
namespace {

bool same_tag(std::string_view a, std::string_view b) {
  const auto lower = [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  };
  return std::ranges::equal(a, b, {}, lower, lower);
}

}  // namespace

const std::string* find_label(const Labels& labels, std::string_view language) {
  while (!language.empty()) {
    for (const auto& [tag, label] : labels)
      if (same_tag(tag, language)) return &label;
    const std::size_t end = language.rfind('-');
    language = language.substr(0, end == std::string_view::npos ? 0 : end);
  }
  return nullptr;
}

const std::string& label_or(const Labels& labels, std::string_view language,
                            const std::string& name) {
  const std::string* label = find_label(labels, language);
  return label && !label->empty() ? *label : name;
}

}  // namespace strata
