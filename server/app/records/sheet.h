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
  std::string name;  // of the file, without the extension
  std::vector<std::string> heads;
  std::vector<std::vector<SheetCell>> rows;  // all rows have the same number of cells
  // for XLSX, by column; may be shorter or empty: the spreadsheet chooses
  std::vector<std::string> number_formats{};
};

// Keeps the columns whose heads end with `area_m2`, for scripts, and appends each of them again in
// the unit that suits its largest value.
void add_readable_areas(Sheet& sheet);

// Writes CSV with a byte order mark, which spreadsheets need; escapes a text that one would run as
// a formula.
std::string csv_text(const Sheet& sheet, char separator);
// Writes XLSX to a file in `folder`. The filters of its head exclude the last row, which has
// totals. Refused (storage_full): the disk is full.
Result<std::shared_ptr<const TemporaryFile>> write_workbook(const Sheet& sheet,
                                                            const std::filesystem::path& folder);

}  // namespace strata::app
