#include "app/bills/bill_workbook.h"

#include <xlsxwriter.h>

#include <array>

#include "app/records/workbook.h"
#include "bill/items.h"
#include "core/log.h"
#include "core/text/printable.h"
#include "core/text/slug.h"
#include "core/text/utf8.h"
#include "core/uuid.h"

namespace strata::app {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxBillCell = 8000;  // characters, fewer than Excel allows
constexpr std::array kBillHeads{"Number",   "Text",     "Unit",       "Tendered",
                                "Quantity", "Rounding", "Unit price", "Total"};
constexpr std::array kLineHeads{"Number",  "Line",   "Element", "Model",    "Layer",  "Record",
                                "Figure",  "Rule",   "Effect",  "Measured", "Factor", "Billed",
                                "Formula", "Remark", "User",    "Time",     "Page"};
constexpr lxw_col_t kMeasuredColumn = 9, kFactorColumn = 10, kBilledColumn = 11;

// Returns the function of Excel for a rounding.
const char* rounding_function(const protocol::BillRounding& rounding) {
  switch (rounding.mode) {
    case protocol::BillRoundingMode::half_up: return "ROUND";
    case protocol::BillRoundingMode::up: return "ROUNDUP";
    case protocol::BillRoundingMode::down: return "ROUNDDOWN";
  }
  return "ROUND";
}

std::string rounding_formula(const protocol::BillRounding& rounding, const std::string& value) {
  return std::string(rounding_function(rounding)) + "(" + value + "," +
         std::to_string(rounding.places) + ")";
}

class BillSheets {
 public:
  explicit BillSheets(const fs::path& folder)
      : file_(std::make_shared<TemporaryFile>(folder / (to_string(random_uuid()) + ".xlsx"))) {
    book_ = workbook_new(file_->path.c_str());
    if (!book_) return;
    bill_ = workbook_add_worksheet(book_, "Bill");
    lines_ = workbook_add_worksheet(book_, "Lines");
    bold_ = workbook_add_format(book_);
    format_set_bold(bold_);
    for (std::size_t i = 0; i < kBillHeads.size(); ++i)
      head(bill_, static_cast<lxw_col_t>(i), kBillHeads[i]);
    for (std::size_t i = 0; i < kLineHeads.size(); ++i)
      head(lines_, static_cast<lxw_col_t>(i), kLineHeads[i]);
    note(worksheet_set_column(bill_, 1, 1, 50, nullptr));
    note(worksheet_set_column(lines_, 2, 2, 30, nullptr));
    worksheet_freeze_panes(bill_, 1, 0);
    worksheet_freeze_panes(lines_, 1, 0);
  }
  ~BillSheets() {
    if (book_) workbook_close(book_);
  }
  BillSheets(const BillSheets&) = delete;
  BillSheets& operator=(const BillSheets&) = delete;

  void add(const protocol::BillItem& item, const bill::Position& position) {
    if (!book_) return;
    const bool is_group = item.kind == protocol::BillItemKind::group;
    text(bill_, bill_row_, 0, item.number, is_group ? bold_ : nullptr);
    text(bill_, bill_row_, 1, item.short_text, is_group ? bold_ : nullptr);
    if (!is_group) add_position(item, position);
    ++bill_row_;
  }

  Result<std::shared_ptr<const TemporaryFile>> finish(const MeasuredBill& measured) {
    if (book_) {
      text(bill_, bill_row_, 1, "Total (" + measured.bill.currency + ")", bold_);
      // The rows of the positions are 2 to bill_row_. An empty bill has none.
      const std::string sum = bill_row_ < 2 ? "0" : "SUM(H2:H" + std::to_string(bill_row_) + ")";
      formula(bill_, bill_row_, 7, sum, measured.total);
      note(workbook_close(book_));
    }
    const bool has_book = book_ != nullptr;
    book_ = nullptr;
    if (!has_book || error_ != LXW_NO_ERROR) {
      log::error(std::string("a workbook could not be written: ") + lxw_strerror(error_));
      return fail(ErrorCode::storage_full, "Workbook not written",
                  "The server could not write a temporary file; its disk may be full. Try again "
                  "later.",
                  "f");
    }
    std::error_code ignored;
    file_->bytes = fs::file_size(file_->path, ignored);
    file_->name = make_slug(measured.bill.name) + ".xlsx";
    file_->media_type = kXlsxType;
    return file_;
  }

 private:
  void note(lxw_error outcome) {
    if (error_ == LXW_NO_ERROR) error_ = outcome;
  }
  void head(lxw_worksheet* sheet, lxw_col_t column, const char* name) {
    note(worksheet_set_column(sheet, column, column, 14, nullptr));
    note(worksheet_write_string(sheet, 0, column, name, bold_));
  }
  void text(lxw_worksheet* sheet, lxw_row_t row, lxw_col_t column, const std::string& value,
            lxw_format* format = nullptr) {
    if (value.empty()) return;
    const std::string shown(first_bytes(printable(value), kMaxBillCell));
    note(worksheet_write_string(sheet, row, column, shown.c_str(), format));
  }
  void number(lxw_worksheet* sheet, lxw_row_t row, lxw_col_t column,
              const bill::ExactNumber& value) {
    note(worksheet_write_number(sheet, row, column, value.approximate(), nullptr));
  }
  // Programs that do not compute show the result that the server computed.
  void formula(lxw_worksheet* sheet, lxw_row_t row, lxw_col_t column, const std::string& what,
               const bill::ExactNumber& result) {
    note(worksheet_write_formula_num(sheet, row, column, ("=" + what).c_str(), nullptr,
                                     result.approximate()));
  }

  void add_position(const protocol::BillItem& item, const bill::Position& position) {
    const auto rounding = item.rounding.value_or(protocol::BillRounding{});
    const std::string row = std::to_string(bill_row_ + 1);
    text(bill_, bill_row_, 2, item.unit);
    if (item.quantity) number(bill_, bill_row_, 3, *bill::ExactNumber::parse(*item.quantity));
    const lxw_row_t first = line_row_ + 1;
    for (const bill::Line& line : position.lines) add_line(item, rounding, line);
    const std::string sum = position.lines.empty() ? "0"
                                                   : "SUM(Lines!L" + std::to_string(first) + ":L" +
                                                         std::to_string(line_row_) + ")";
    formula(bill_, bill_row_, 4, rounding_formula(rounding, sum), position.quantity);
    text(bill_, bill_row_, 5, bill::rounding_text(item));
    if (!item.unit_price) return;
    number(bill_, bill_row_, 6, *bill::ExactNumber::parse(*item.unit_price));
    formula(bill_, bill_row_, 7, "ROUND(E" + row + "*G" + row + ",2)", *position.total);
  }

  void add_line(const protocol::BillItem& item, const protocol::BillRounding& rounding,
                const bill::Line& line) {
    const bill::Element& element = line.element;
    const std::array texts{item.number,
                           element.id,
                           element.title,
                           element.model_name,
                           element.layer_name,
                           element.key > 0 ? std::to_string(element.key) : std::string(),
                           line.figure,
                           line.rule > 0 ? std::to_string(line.rule) : std::string(),
                           std::string(name(line.effect))};
    for (std::size_t i = 0; i < texts.size(); ++i)
      text(lines_, line_row_, static_cast<lxw_col_t>(i), texts[i]);
    number(lines_, line_row_, kMeasuredColumn, element.measured);
    number(lines_, line_row_, kFactorColumn, line.factor);
    add_billed(rounding, line);
    const std::array more{line.formula, line.remark, line.user, line.time, element.link};
    for (std::size_t i = 0; i < more.size(); ++i)
      text(lines_, line_row_, static_cast<lxw_col_t>(kBilledColumn + 1 + i), more[i]);
    ++line_row_;
  }

  void add_billed(const protocol::BillRounding& rounding, const bill::Line& line) {
    const std::string row = std::to_string(line_row_ + 1);
    std::string value = "J" + row + "*K" + row;
    switch (line.effect) {
      case bill::Effect::overmeasured:
      case bill::Effect::replaced: value = "0"; break;
      case bill::Effect::deducted: value = "-" + value; break;
      case bill::Effect::smallest: value = *rounding.smallest + "*K" + row; break;
      case bill::Effect::billed: break;
    }
    if (rounding.each == protocol::BillRoundingEach::element)
      value = rounding_formula(rounding, value);
    formula(lines_, line_row_, kBilledColumn, value, line.billed);
  }

  std::shared_ptr<TemporaryFile> file_;
  lxw_workbook* book_ = nullptr;  // freed only by workbook_close
  lxw_worksheet *bill_ = nullptr, *lines_ = nullptr;
  lxw_format* bold_ = nullptr;
  lxw_row_t bill_row_ = 1, line_row_ = 1;
  lxw_error error_ = LXW_NO_ERROR;
};

}  // namespace

Result<std::shared_ptr<const TemporaryFile>> bill_workbook(const MeasuredBill& measured,
                                                           const fs::path& folder) {
  BillSheets sheets(folder);
  const auto items = bill::items_of(measured.bill);
  for (std::size_t i = 0; i < items.size(); ++i) sheets.add(items[i], measured.positions[i]);
  return sheets.finish(measured);
}

}  // namespace strata::app
