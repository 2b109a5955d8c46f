#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

struct CsvLimits {
  std::size_t rows = 1'000'000;
  std::size_t columns = 1000;  // per row
};

struct CsvRow {
  // The line where the row begins, from 1. A row with quoted cells can have several lines.
  int line = 0;
  std::vector<std::string> cells;
};

struct CsvText {
  char separator = ',';
  std::vector<CsvRow> rows;  // the first row names the columns; empty rows are left out
};

// Reads RFC 4180 and common variants: UTF-8 with or without a byte order mark, and rows that end
// with LF, CRLF or CR. A first row `sep=;`, as Excel writes it, names the separator. Otherwise the
// separator is the most frequent of comma, semicolon and tab in the first row, outside of quotes.
// Returns an `invalid` error with the line number for invalid UTF-8, an unclosed quote, and text
// after a closing quote.
Result<CsvText> parse_csv(std::string_view text, const CsvLimits& limits = {});

inline constexpr std::string_view kUtf8Mark =
    "\xef\xbb\xbf";  // without it, Excel assumes the legacy encoding of the machine

// Writes one row with CRLF. Quotes cells that need quotes, and texts that contain any separator.
std::string csv_line(const std::vector<std::string>& cells, char separator);
// Writes one cell, without a separator, of a row that has several cells.
void append_csv_cell(std::string& line, std::string_view cell, char separator);

// Returns the shortest text that is read as the same number. If the separator is a semicolon, the
// text has a decimal comma, as in the countries where Excel writes semicolons.
std::string csv_number(double value, char separator);

// Spreadsheets evaluate a text that begins with = + - @ (also full-width) as a formula.
// `guard_formula` inserts an apostrophe before such a text, so spreadsheets display the text. It
// also inserts one before a text that already has such an apostrophe. A spreadsheet may split a
// text if it expects a different separator. The parts after a comma, semicolon, tab or line end are
// therefore guarded as well. `unguard_formula` removes the apostrophes and restores the original
// text.
std::string guard_formula(std::string text);
std::string unguard_formula(std::string text);

}  // namespace strata
