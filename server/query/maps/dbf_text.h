#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace strata::query {

// Converts the texts of a .dbf file to UTF-8. Their encoding is the one that the .cpg file names
// ("UTF-8", "1252", "ISO 88591"), otherwise the code page that the .dbf file names ("LDID/87"). If
// neither is known, valid UTF-8 is read as UTF-8, and other text as Windows-1252.
class DbfText {
 public:
  DbfText(std::string_view cpg, const char* code_page);  // null if not given
  std::string utf8(std::string_view text) const;         // without trailing blanks

 private:
  std::string encoding_;  // name for iconv; empty if not known
};

}  // namespace strata::query
