#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

struct CsvLimits {
  std::size_t rows = 1'000'000;
  std::size_t columns = 1000;  // of a row
};

struct CsvRow {
  int line = 0;  // where it begins in the text, from 1; a quoted cell may hold more lines
  std::vector<std::string> cells;
};

struct CsvText {
  char separator = ',';
  std::vector<CsvRow> rows;  // the first one names the columns; rows without anything are left out
};

// Reads RFC 4180 as it is met: UTF-8 with or without a byte order mark; rows end with LF, CRLF or
// CR; cells are separated by comma, semicolon or tab, whichever stands most often in the first row
// outside of quotes, or is named by a first row `sep=;` as Excel writes it. An Error (invalid)
// names the line: bytes that are not UTF-8, a quote that does not end, text behind one.
Result<CsvText> parse_csv(std::string_view text, const CsvLimits& limits = {});

inline constexpr std::string_view kUtf8Mark =
    "\xef\xbb\xbf";  // without it, Excel takes UTF-8 for the machine's old encoding

// One row with CRLF at its end; cells are quoted where they must be, and texts with any separator
// in them.
std::string csv_line(const std::vector<std::string>& cells, char separator);
// One cell of a row that has others, without what separates it from them.
void append_csv_cell(std::string& line, std::string_view cell, char separator);

// The shortest text that reads back as the number; with a decimal comma where semicolons separate
// the cells, as in the countries whose Excel writes semicolons.
std::string csv_number(double value, char separator);

// Spreadsheets run a text that begins with = + - @ (also full-width ones) as a formula.
// `guard_formula` puts an apostrophe before such a text, which they show as text, and before one
// that has such an apostrophe already. A spreadsheet that separates cells by another character than
// the file splits a text, so that parts behind a comma, semicolon, tab or line end are guarded in
// the same way. `unguard_formula` takes the apostrophes away, so that texts come back as they were.
std::string guard_formula(std::string text);
std::string unguard_formula(std::string text);

}  // namespace strata
