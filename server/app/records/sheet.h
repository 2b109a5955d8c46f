#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/temporary_file.h"

// Tables for spreadsheets.
namespace strata::app {

using SheetCell = std::variant<std::monostate, double, std::string>;

struct Sheet {
  std::string name;  // file name without the extension
  std::vector<std::string> heads;
  std::vector<std::vector<SheetCell>> rows;  // all rows have the same length
  // Number formats for XLSX, by column. May be shorter than the row or contain empty texts. The
  // spreadsheet program then chooses the format.
  std::vector<std::string> number_formats{};
  bool has_totals = true;  // in the last row
};

// Keeps the columns whose names end with `area_m2`, for scripts. Appends a copy of each in the unit
// that suits its largest value.
void add_readable_areas(Sheet& sheet);

// Returns CSV with a byte order mark, which spreadsheet programs need. Escapes text that such a
// program would run as a formula.
std::string csv_text(const Sheet& sheet, char separator);
// Writes the text of `csv_text` to a file in `folder`. Returns storage_full if the disk is full.
Result<std::shared_ptr<const TemporaryFile>> write_csv(const Sheet& sheet, char separator,
                                                       const std::filesystem::path& folder);
// Writes XLSX to a file in `folder`. The filters in the first row exclude a last row of totals.
// Returns storage_full if the disk is full.
Result<std::shared_ptr<const TemporaryFile>> write_workbook(const Sheet& sheet,
                                                            const std::filesystem::path& folder);

}  // namespace strata::app
