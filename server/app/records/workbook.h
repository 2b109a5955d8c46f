#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/temporary_file.h"
#include "domain/tables/table.h"

namespace strata::app {

inline constexpr const char* kXlsxType =
    "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet";

struct BookDate {
  int year = 1900, month = 1, day = 1;  // Excel supports the years 1900 to 9999
  bool has_time = false;
  int hour = 0, minute = 0;
  double second = 0;
};
using BookCell = std::variant<std::monostate, bool, double, BookDate, std::string>;

// Returns the cell of a record with its type. Numbers, booleans, dates and UTC times keep their
// types. All other values, including dates before 1900, are text.
BookCell book_cell(const Record& record, const Column& column);

struct BookColumn {
  std::string head;
  std::string number_format;  // in the syntax of Excel; empty: Excel's default
};

// Writes a workbook (XLSX) with one sheet to a file. Writes row by row, so the memory does not grow
// with the number of rows. Texts stay texts, even if they look like formulas or escapes
// (`_x000D_`). Escapes characters that XML does not allow. Shortens texts to the 32 767 characters
// of an Excel cell, with an ellipsis at the end.
class Workbook {
 public:
  static constexpr std::size_t kMaxRows = 1'048'575;  // without the first row

  // Creates a file in the folder. The first row is bold and stays visible when the user scrolls.
  Workbook(const std::filesystem::path& folder, const std::string& sheet_name,
           const std::vector<BookColumn>& columns);
  ~Workbook();
  Workbook(const Workbook&) = delete;
  Workbook& operator=(const Workbook&) = delete;

  void add_row(const std::vector<BookCell>& cells);
  // Ends the range of the filters in the first row after the current row.
  void end_filter();
  // Returns the file. `name` is the file name for the user. Returns storage_full if the disk is
  // full. Do not add rows afterwards.
  Result<std::shared_ptr<const TemporaryFile>> finish(const std::string& name);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::app
