#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace strata::query {

// Texts of a .dbf as UTF-8. Their encoding is what the .cpg says ("UTF-8", "1252", "ISO 88591"),
// else the code page that the .dbf names ("LDID/87"); where neither is known, a text that is valid
// UTF-8 is that, and others are Windows-1252.
class DbfText {
 public:
  DbfText(std::string_view cpg, const char* code_page);  // null: none
  std::string utf8(std::string_view text) const;         // blanks at its end taken off

 private:
  std::string encoding_;  // as iconv calls it; empty: not known
};

}  // namespace strata::query
