#include "app/records/workbook.h"

#include <xlsxwriter.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include "app/records/sheet.h"
#include "core/log.h"
#include "core/uuid.h"
#include "domain/tables/column_value.h"

namespace strata::app {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxCellLength = 32'767;  // in UTF-16 units
constexpr std::size_t kMaxSheetNameLength = 31;

// Returns the number of bytes in the first UTF-8 character of a valid text.
std::size_t character_bytes(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  return first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

// Returns whether the first character of a text is escaped in the file. This applies to CR and to
// characters that XML does not allow.
bool is_escaped(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  return (first < 0x20 && first != '\t' && first != '\n') || text.starts_with("\ufffe") ||
         text.starts_with("\uffff");
}

// Returns whether the text begins like an escape of Excel: `_x`, four hexadecimal digits and `_`.
bool begins_escape(std::string_view text) {
  return text.size() >= 7 && text.starts_with("_x") &&
         (text[6] == '_' || is_escaped(text.substr(6))) &&
         std::ranges::all_of(text.substr(2, 4),
                             [](unsigned char c) { return std::isxdigit(c) != 0; });
}

// Returns the first character of a text as a cell contains it (ECMA-376 Part 1, 22.9.2.19,
// ST_Xstring). The library escapes control characters itself.
std::string escaped(std::string_view text, std::string_view character) {
  if (begins_escape(text)) return "_x005F_";
  if (character == "\ufffe") return "_xFFFE_";
  if (character == "\uffff") return "_xFFFF_";
  return std::string(character);
}

// The library counts all characters of an escape, but Excel counts an escape as one character. The
// text must satisfy both limits.
std::string cell_text(std::string_view text) {
  std::string out;
  std::size_t units = 0, written = 0, before_last = 0;
  while (!text.empty()) {
    const std::string_view character = text.substr(0, character_bytes(text));
    const std::string cell = escaped(text, character);
    text.remove_prefix(character.size());
    units += character.size() == 4 ? 2 : 1;
    written += cell.size() > 4 ? cell.size() : 1;
    if (std::max(units, written) > kMaxCellLength) {
      out.resize(before_last);
      return out + "\u2026";
    }
    out += cell;
    if (std::max(units, written) < kMaxCellLength) before_last = out.size();
  }
  return out;
}

std::optional<BookDate> parse_date(std::string_view text, bool has_time) {
  const auto number = [&](std::size_t at, std::size_t digits) {
    int value = -1;
    if (text.size() >= at + digits)
      std::from_chars(text.data() + at, text.data() + at + digits, value);
    return value;
  };
  BookDate date{number(0, 4), number(5, 2), number(8, 2), has_time};
  if (text.size() < 10 || date.year < 1900 || date.month < 1 || date.day < 1) return std::nullopt;
  if (!has_time) return date;
  date.hour = number(11, 2);
  date.minute = number(14, 2);
  if (text.size() < 19) return std::nullopt;
  std::from_chars(text.data() + 17, text.data() + text.size(), date.second);  // ends before the Z
  return date;
}

}  // namespace

BookCell book_cell(const Record& record, const Column& column) {
  const auto found = record.values.find(column.id);
  if (found == record.values.end() || found->second.is_null()) return {};
  const nlohmann::json& value = found->second;
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number()) return value.get<double>();
  if (!value.is_string()) return print_value(column, value);
  const auto& text = value.get_ref<const std::string&>();
  if (column.kind == ColumnKind::date || column.kind == ColumnKind::timestamp)
    if (const auto date = parse_date(text, column.kind == ColumnKind::timestamp)) return *date;
  return text;
}

struct Workbook::Impl {
  std::shared_ptr<TemporaryFile> file;
  lxw_workbook* book = nullptr;  // freed only by workbook_close
  lxw_worksheet* sheet = nullptr;
  lxw_format *bold = nullptr, *date = nullptr, *time = nullptr;
  std::vector<lxw_format*> numbers;  // by column; null: Excel's default
  lxw_row_t rows = 1;
  bool is_filtered = false;
  lxw_error error = LXW_NO_ERROR;

  void note(lxw_error outcome) {
    if (error == LXW_NO_ERROR) error = outcome;
  }
};

Workbook::Workbook(const fs::path& folder, const std::string& sheet_name,
                   const std::vector<BookColumn>& columns)
    : impl_(std::make_unique<Impl>()) {
  Impl& book = *impl_;
  book.file = std::make_shared<TemporaryFile>(folder / (to_string(random_uuid()) + ".xlsx"));
  std::string temporary = folder.string();
  lxw_workbook_options options{};
  options.constant_memory = LXW_TRUE;
  options.tmpdir = temporary.data();  // the library copies it
  book.book = workbook_new_opt(book.file->path.c_str(), &options);
  if (book.book)
    book.sheet =
        workbook_add_worksheet(book.book, sheet_name.substr(0, kMaxSheetNameLength).c_str());
  if (!book.sheet) {
    book.error = LXW_ERROR_CREATING_TMPFILE;
    return;
  }
  book.bold = workbook_add_format(book.book);
  format_set_bold(book.bold);
  book.date = workbook_add_format(book.book);
  format_set_num_format(book.date, "yyyy-mm-dd");
  book.time = workbook_add_format(book.book);
  format_set_num_format(book.time, "yyyy-mm-dd hh:mm:ss");
  worksheet_freeze_panes(book.sheet, 1, 0);
  for (const auto& [head, number_format] : columns) {
    const auto width = std::clamp(static_cast<double>(head.size()) + 4, 12.0, 40.0);
    const auto column = static_cast<lxw_col_t>(book.numbers.size());
    book.note(worksheet_set_column(book.sheet, column, column, width, nullptr));
    book.note(worksheet_write_string(book.sheet, 0, column, cell_text(head).c_str(), book.bold));
    book.numbers.push_back(number_format.empty() ? nullptr : workbook_add_format(book.book));
    if (book.numbers.back()) format_set_num_format(book.numbers.back(), number_format.c_str());
  }
}

Workbook::~Workbook() {
  if (impl_->book) workbook_close(impl_->book);
}

void Workbook::add_row(const std::vector<BookCell>& cells) {
  Impl& book = *impl_;
  if (book.error != LXW_NO_ERROR) return;
  lxw_col_t column = 0;
  for (const BookCell& cell : cells) {
    if (const auto* is_true = std::get_if<bool>(&cell)) {
      book.note(worksheet_write_boolean(book.sheet, book.rows, column, *is_true, nullptr));
    } else if (const auto* number = std::get_if<double>(&cell)) {
      book.note(
          worksheet_write_number(book.sheet, book.rows, column, *number, book.numbers.at(column)));
    } else if (const auto* date = std::get_if<BookDate>(&cell)) {
      lxw_datetime when{date->year, date->month, date->day, date->hour, date->minute, date->second};
      book.note(worksheet_write_datetime(book.sheet, book.rows, column, &when,
                                         date->has_time ? book.time : book.date));
    } else if (const auto* text = std::get_if<std::string>(&cell); text && !text->empty()) {
      book.note(
          worksheet_write_string(book.sheet, book.rows, column, cell_text(*text).c_str(), nullptr));
    }
    ++column;
  }
  ++book.rows;
}

// Writes the filter immediately because the library does not accept rows before the current one.
void Workbook::end_filter() {
  Impl& book = *impl_;
  if (book.is_filtered || !book.sheet || book.numbers.empty()) return;
  book.is_filtered = true;
  book.note(worksheet_autofilter(book.sheet, 0, 0, book.rows - 1,
                                 static_cast<lxw_col_t>(book.numbers.size() - 1)));
}

Result<std::shared_ptr<const TemporaryFile>> Workbook::finish(const std::string& name) {
  Impl& book = *impl_;
  end_filter();
  if (book.book) book.note(workbook_close(book.book));
  book.book = nullptr;
  if (book.error != LXW_NO_ERROR) {
    log::error(std::string("a workbook could not be written: ") + lxw_strerror(book.error));
    return fail(ErrorCode::storage_full, "Workbook not written",
                "The server could not write a temporary file; its disk may be full. Request "
                "CSV instead, which needs no temporary file.",
                "f");
  }
  std::error_code ignored;
  book.file->bytes = fs::file_size(book.file->path, ignored);
  book.file->name = name;
  book.file->media_type = kXlsxType;
  return book.file;
}

}  // namespace strata::app
