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
  int line = 0;  // of its begin in the text, from 1; a quoted cell may have more lines
  std::vector<std::string> cells;
};

struct CsvText {
  char separator = ',';
  std::vector<CsvRow> rows;  // the first one names the columns; without empty rows
};

// Reads RFC 4180 and common variants: UTF-8 with or without a byte order mark; rows end with LF,
// CRLF or CR. The separator is the one that a first row `sep=;` names, as Excel writes it,
// otherwise the most frequent of comma, semicolon and tab in the first row outside of quotes. An
// Error (invalid) names the line: invalid UTF-8, an unclosed quote, text after a closing quote.
Result<CsvText> parse_csv(std::string_view text, const CsvLimits& limits = {});

inline constexpr std::string_view kUtf8Mark =
    "\xef\xbb\xbf";  // otherwise Excel assumes the machine's legacy encoding

// Writes one row with CRLF; quotes cells where needed, and texts with any separator.
std::string csv_line(const std::vector<std::string>& cells, char separator);
// Writes one cell of a row with several cells, without the separator.
void append_csv_cell(std::string& line, std::string_view cell, char separator);

// Returns the shortest text that reads back as the number; with a decimal comma if the separator is
// a semicolon, as in the countries whose Excel writes semicolons.
std::string csv_number(double value, char separator);

// Spreadsheets run a text that begins with = + - @ (also full-width ones) as a formula.
// `guard_formula` inserts an apostrophe before such a text, so that spreadsheets show it, and
// before one that has such an apostrophe already. A spreadsheet with another separator than the
// file splits a text, so parts after a comma, semicolon, tab or line end are guarded likewise.
// `unguard_formula` removes the apostrophes and restores the original text.
std::string guard_formula(std::string text);
std::string unguard_formula(std::string text);

}  // namespace strata
