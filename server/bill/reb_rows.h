#pragma once

#include <string>
#include <vector>

#include "bill/measure.h"
#include "core/error.h"

namespace strata::bill {

// Writes proof lines as rows of 80 characters, as X31 contains them (REB-VB 23.003, edition 2009):
// a comment row has a `*` in column 13 and its text in columns 14 to 68, and a row of the formula
// 91 has `91` in columns 30 and 31 and a formula that ends with `=` in columns 34 to 68. Columns 70
// to 75 contain the address of the row: sheet, row letter and index.
class RebRows {
 public:
  // Returns the rows of a line: its element, figure and remark as comments, and what it adds to the
  // quantity. The formula of a hand measurement is kept if it fits and is not rounded. Returns an
  // `invalid` error if the file has too many rows.
  Result<std::vector<std::string>> of(const Line& line, const protocol::BillItem& item);

 private:
  Result<std::string> next_address();
  Result<void> add_comment(std::vector<std::string>& rows, const std::string& text);

  std::size_t next_ = 0;
};

}  // namespace strata::bill
