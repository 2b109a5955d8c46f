#include "net/sheet.h"

#include <algorithm>

#include "core/csv.h"
#include "net/readable_area.h"
#include "net/workbook.h"

namespace strata::net {
Result<SheetFormat> sheet_format(const Request& request) {
  const auto asked = request.query.find("f");
  if (asked == request.query.end()) {
    const std::string_view accepted = request.header("accept");
    if (accepted.find("text/csv") != std::string_view::npos) return SheetFormat::csv;
    return accepted.find(kXlsxType) != std::string_view::npos ? SheetFormat::xlsx
                                                              : SheetFormat::json;
  }
  if (asked->second == "json") return SheetFormat::json;
  if (asked->second == "csv") return SheetFormat::csv;
  if (asked->second == "xlsx") return SheetFormat::xlsx;
  return fail(ErrorCode::not_acceptable, "Unknown format", "`f` is json, csv or xlsx.", "f");
}

Result<char> csv_separator(const Request& request) {
  const std::string text = request.query_or("separator", "comma");
  if (text == "comma") return ',';
  if (text == "semicolon") return ';';
  if (text == "tab") return '\t';
  return fail(ErrorCode::invalid, "Unknown separator", "`separator` is comma, semicolon or tab.",
              "separator");
}

namespace {

Response csv_response(const Sheet& sheet, char separator) {
  std::string text(kUtf8Mark);
  std::vector<std::string> cells;
  for (const std::string& head : sheet.heads) cells.push_back(guard_formula(head));
  text += csv_line(cells, separator);
  for (const auto& row : sheet.rows) {
    cells.clear();
    for (const SheetCell& cell : row)
      if (const auto* number = std::get_if<double>(&cell))
        cells.push_back(csv_number(*number, separator));
      else if (const auto* words = std::get_if<std::string>(&cell))
        cells.push_back(guard_formula(*words));
      else
        cells.emplace_back();
    text += csv_line(cells, separator);
  }
  Response response = text_response(std::move(text), kCsvType);
  name_download(response, sheet.name + ".csv");
  return response;
}

constexpr std::string_view kArea = "area_m2";

double largest_of(const Sheet& sheet, std::size_t column) {
  double largest = 0;
  for (const auto& row : sheet.rows)
    if (const auto* number = std::get_if<double>(&row[column]))
      largest = std::max(largest, *number);
  return largest;
}

SheetCell in_unit(const SheetCell& cell, const AreaUnit& unit) {
  const auto* area_m2 = std::get_if<double>(&cell);
  return area_m2 ? SheetCell(*area_m2 * unit.per_m2) : cell;
}

}  // namespace

void add_readable_areas(Sheet& sheet) {
  const std::size_t count = sheet.heads.size();
  sheet.number_formats.resize(count);
  for (std::size_t column = 0; column < count; ++column) {
    if (!sheet.heads[column].ends_with(kArea)) continue;
    const double largest_m2 = largest_of(sheet, column);
    const AreaUnit unit = readable_area(largest_m2);
    sheet.heads.push_back(readable_head(sheet.heads[column], unit));
    sheet.number_formats[column] = number_format(largest_m2);
    sheet.number_formats.push_back(number_format(largest_m2 * unit.per_m2));
    for (auto& row : sheet.rows) row.push_back(in_unit(row[column], unit));
  }
}

Result<Response> sheet_response(const Sheet& sheet, SheetFormat format, char separator,
                                const std::filesystem::path& folder) {
  if (format == SheetFormat::csv) return csv_response(sheet, separator);
  std::vector<BookColumn> columns;
  for (const std::string& head : sheet.heads) columns.push_back({head, {}});
  for (std::size_t i = 0; i < sheet.number_formats.size(); ++i)
    columns[i].number_format = sheet.number_formats[i];
  Workbook book(folder, sheet.name, columns);
  std::vector<BookCell> cells;
  for (const auto& row : sheet.rows) {
    cells.clear();
    for (const SheetCell& cell : row)
      std::visit([&](const auto& value) { cells.emplace_back(value); }, cell);
    if (&row == &sheet.rows.back()) book.end_filter();
    book.add_row(cells);
  }
  return book.finish(sheet.name + ".xlsx");
}

}  // namespace strata::net
