#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace strata::query {

// Converts the texts of a .dbf to UTF-8, from the encoding that the .cpg names ("UTF-8", "1252",
// "ISO 88591"), otherwise from the code page that the .dbf names ("LDID/87"). If neither is known,
// a text that is valid UTF-8 is taken as UTF-8, and others as Windows-1252.
class DbfText {
 public:
  DbfText(std::string_view cpg, const char* code_page);  // null: not given
  std::string utf8(std::string_view text) const;         // without trailing blanks

 private:
  std::string encoding_;  // name for iconv; empty: not known
};

}  // namespace strata::query
