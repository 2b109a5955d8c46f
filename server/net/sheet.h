#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "net/http/http_types.h"

// Tables that people take into a spreadsheet.
namespace strata::net {

inline constexpr const char* kCsvType = "text/csv; charset=utf-8";

enum class SheetFormat { json, csv, xlsx };
// `f`, or where that is absent what Accept names; JSON where neither says anything. 406 for what is
// none of them.
Result<SheetFormat> sheet_format(const Request& request);
// Of CSV: `separator`; 422 for what is none.
Result<char> csv_separator(const Request& request);

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

// As CSV, with a byte order mark, as spreadsheets want it, where a text that one would run as a
// formula is guarded; or as XLSX by way of a file in `folder`. The filters of its head leave the
// last row out, which is one of totals.
Result<Response> sheet_response(const Sheet& sheet, SheetFormat format, char separator,
                                const std::filesystem::path& folder);

}  // namespace strata::net
