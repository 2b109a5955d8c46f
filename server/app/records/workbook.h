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
  int year = 1900, month = 1, day = 1;  // Excel supports 1900 to 9999
  bool has_time = false;
  int hour = 0, minute = 0;
  double second = 0;
};
using BookCell = std::variant<std::monostate, bool, double, BookDate, std::string>;

// Returns the typed value of a record's cell: numbers, booleans, dates and UTC times; everything
// else is text. Dates before 1900 are text.
BookCell book_cell(const Record& record, const Column& column);

struct BookColumn {
  std::string head;
  std::string number_format;  // in Excel's syntax; empty: Excel's default
};

// Writes a workbook (XLSX) of one sheet to a file row by row, so memory does not grow with the
// number of rows. Texts stay texts, also those that look like formulas or escapes (`_x000D_`);
// characters that XML does not allow are escaped, and texts longer than the 32 767 characters of
// Excel's cells end in an ellipsis.
class Workbook {
 public:
  static constexpr std::size_t kMaxRows = 1'048'575;  // without the head

  // Opens a new file in the folder. The first row is bold and stays visible.
  Workbook(const std::filesystem::path& folder, const std::string& sheet_name,
           const std::vector<BookColumn>& columns);
  ~Workbook();
  Workbook(const Workbook&) = delete;
  Workbook& operator=(const Workbook&) = delete;

  void add_row(const std::vector<BookCell>& cells);
  // The head's filters cover the rows so far.
  void end_filter();
  // Returns the file, named `name` for the user. Refused (storage_full): the disk is full. No rows
  // can be added afterwards.
  Result<std::shared_ptr<const TemporaryFile>> finish(const std::string& name);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::app
