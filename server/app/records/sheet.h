#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/temporary_file.h"

// Tables that people take into a spreadsheet.
namespace strata::app {

using SheetCell = std::variant<std::monostate, double, std::string>;

struct Sheet {
  std::string name;  // of the file, without its ending
  std::vector<std::string> heads;
  std::vector<std::vector<SheetCell>> rows;  // of as many cells
  // of XLSX, by column; may be shorter, or empty where spreadsheets choose
  std::vector<std::string> number_formats{};
};

// Columns whose heads end with `area_m2` stay as scripts know them; behind all others they come
// again in the unit that suits the largest value of each.
void add_readable_areas(Sheet& sheet);

// With a byte order mark, as spreadsheets want it; a text that one would run as a formula is
// guarded.
std::string csv_text(const Sheet& sheet, char separator);
// XLSX in a file in `folder`. The filters of its head leave the last row out, which is one of
// totals. Refused (storage_full): the disk had no room.
Result<std::shared_ptr<const TemporaryFile>> write_workbook(const Sheet& sheet,
                                                            const std::filesystem::path& folder);

}  // namespace strata::app
