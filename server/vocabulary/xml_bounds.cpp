#include "vocabulary/xml_bounds.h"

#include <algorithm>

namespace strata {
namespace {

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  Result<void> scan() {
    int depth = 0;
    while (at_ < text_.size()) {
      at_ = std::min(text_.find('<', at_), text_.size());
      if (skip("<!--", "-->") || skip("<![CDATA[", "]]>") || skip("<?", "?>")) continue;
      if (rest().starts_with("<!")) {
        STRATA_TRY(declarations());
        continue;
      }
      const bool ends = rest().starts_with("</");
      const bool is_tag = ends || rest().size() > 1;
      const bool is_empty = tag();
      if (is_tag) depth += ends ? -1 : is_empty ? 0 : 1;
      if (depth > kDeepestXml)
        return fail(
            ErrorCode::invalid, "Nested too deeply",
            "its elements are nested more than " + std::to_string(kDeepestXml) + " levels deep",
            "body");
    }
    return {};
  }

 private:
  std::string_view rest() const { return text_.substr(at_); }

  void go_behind(std::string_view end) {
    const auto found = text_.find(end, at_);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
  }

  bool skip(std::string_view begin, std::string_view end) {
    if (!rest().starts_with(begin)) return false;
    at_ += begin.size();
    go_behind(end);
    return true;
  }

  // Moves to the position after the next `>` outside of quotes. Returns whether a slash precedes
  // the `>`.
  bool tag() {
    for (++at_; at_ < text_.size() && text_[at_] != '>'; ++at_)
      if (text_[at_] == '"' || text_[at_] == '\'')
        at_ = std::min(text_.find(text_[at_], at_ + 1), text_.size() - 1);
    const bool is_empty = at_ < text_.size() && text_[at_ - 1] == '/';
    at_ = std::min(at_ + 1, text_.size());
    return is_empty;
  }

  // Checks a document type and its declarations.
  Result<void> declarations() {
    const auto end_of_document_type = [&] {
      at_ = std::min(at_ + 1, text_.size());
      return Result<void>{};
    };
    for (++at_; at_ < text_.size();) {
      const char c = text_[at_];
      if (skip("<!--", "-->") || skip("<?", "?>")) continue;
      if (rest().starts_with("<!ENTITY")) {
        STRATA_TRY(entity());
      } else if (c == '<') {
        tag();
      } else if (c == '"' || c == '\'') {
        at_ = std::min(text_.find(c, at_ + 1), text_.size() - 1) + 1;
      } else if (c == '[') {
        in_subset_ = true;
        ++at_;
      } else if (c == ']') {
        in_subset_ = false;
        ++at_;
      } else if (c == '>' && !in_subset_) {
        return end_of_document_type();
      } else {
        ++at_;
      }
    }
    return {};
  }

  Result<void> entity() {
    const std::size_t begin = at_;
    tag();
    const std::string_view declared = text_.substr(begin + 1, at_ - begin - 1);
    const bool is_plain = declared.find_first_of("<&%") == std::string_view::npos &&
                          declared.find("SYSTEM") == std::string_view::npos &&
                          declared.find("PUBLIC") == std::string_view::npos;
    if (is_plain) return {};
    return fail(ErrorCode::invalid, "Entity not allowed",
                "it contains an entity that is not plain text", "body");
  }

  const std::string_view text_;
  std::size_t at_ = 0;
  bool in_subset_ = false;
};

}  // namespace

Result<void> check_xml_bounds(std::string_view text) { return Scanner(text).scan(); }

}  // namespace strata
