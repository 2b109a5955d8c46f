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
  int year = 1900, month = 1, day = 1;  // from 1900 to 9999, which is what Excel counts
  bool has_time = false;
  int hour = 0, minute = 0;
  double second = 0;
};
using BookCell = std::variant<std::monostate, bool, double, BookDate, std::string>;

// The value of a record's cell: numbers, booleans, dates and UTC times as what they are, everything
// else as text. Dates before 1900 are text.
BookCell book_cell(const Record& record, const Column& column);

struct BookColumn {
  std::string head;
  std::string number_format;  // as Excel writes it; empty: as Excel shows numbers
};

// A workbook (XLSX) of one sheet on its way to a file: rows are written as they come, so that it
// takes little memory however many there are. Texts are texts, also those that look like formulas
// or like escapes (`_x000D_`); what XML cannot hold is escaped, and beyond the 32 767 characters of
// Excel's cells they end in an ellipsis.
class Workbook {
 public:
  static constexpr std::size_t kMaxRows = 1'048'575;  // beside the head

  // In a file of its own in the folder. The first row is bold and stays in sight.
  Workbook(const std::filesystem::path& folder, const std::string& sheet_name,
           const std::vector<BookColumn>& columns);
  ~Workbook();
  Workbook(const Workbook&) = delete;
  Workbook& operator=(const Workbook&) = delete;

  void add_row(const std::vector<BookCell>& cells);
  // The filters of the head choose from the rows until now.
  void end_filter();
  // The file, called `name` for the user. Refused (storage_full): the disk had no room. Nothing can
  // be added after that.
  Result<std::shared_ptr<const TemporaryFile>> finish(const std::string& name);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::app
