#include "app/records/sheet.h"

#include <algorithm>
#include <fstream>

#include "app/records/readable_area.h"
#include "app/records/workbook.h"
#include "core/text/csv.h"
#include "core/uuid.h"

namespace strata::app {
namespace {

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

std::string csv_text(const Sheet& sheet, char separator) {
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
  return text;
}

Result<std::shared_ptr<const TemporaryFile>> write_csv(const Sheet& sheet, char separator,
                                                       const std::filesystem::path& folder) {
  auto file = std::make_shared<TemporaryFile>(folder / (to_string(random_uuid()) + ".csv"));
  file->name = sheet.name + ".csv";
  file->media_type = "text/csv; charset=utf-8";
  const std::string text = csv_text(sheet, separator);
  file->bytes = text.size();
  std::ofstream out(file->path, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out)
    return fail(ErrorCode::storage_full, "File not written",
                "The disk of the server is full or not writable, so the file was not made.");
  return file;
}

Result<std::shared_ptr<const TemporaryFile>> write_workbook(const Sheet& sheet,
                                                            const std::filesystem::path& folder) {
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
    if (sheet.has_totals && &row == &sheet.rows.back()) book.end_filter();
    book.add_row(cells);
  }
  return book.finish(sheet.name + ".xlsx");
}

}  // namespace strata::app
