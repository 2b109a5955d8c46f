#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace strata::query {

// Converts the texts of a .dbf file to UTF-8. The .cpg file contains their encoding ("UTF-8",
// "1252", "ISO 88591"). Without it, the .dbf file may contain their code page ("LDID/87"). If
// neither is known, valid UTF-8 is read as UTF-8, and other text as Windows-1252.
class DbfText {
 public:
  DbfText(std::string_view cpg, const char* code_page);  // null if not given
  std::string utf8(std::string_view text) const;         // without trailing blanks

 private:
  std::string encoding_;  // name for iconv; empty if not known
};

}  // namespace strata::query
