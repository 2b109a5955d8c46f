#include "app/records/texel_csv.h"

#include <charconv>
#include <string_view>

#include "app/records/record_csv.h"
#include "core/text/csv.h"

namespace strata::app {

void TexelCsv::add_records(const std::vector<Record>& records, const std::vector<Column>& columns) {
  for (const Column& column : columns) columns_.push_back(column.slug);
  no_record_.assign(columns.size(), separator_);
  for (const Record& record : records) {
    std::string& text = of_record_[static_cast<std::uint32_t>(record.key)];
    for (const Column& column : columns) {
      text += separator_;
      append_csv_cell(text, record_cell(record, column, separator_), separator_);
    }
  }
}

std::string TexelCsv::head() const {
  std::vector<std::string> cells{"x", "y", "z", "area_m2", "value"};
  cells.insert(cells.end(), columns_.begin(), columns_.end());
  return std::string(kUtf8Mark) + csv_line(cells, separator_);
}

void TexelCsv::append(std::string& text, const query::TexelSample& sample, bool is_cell) const {
  for (int axis = 0; axis < 3; ++axis) {
    append_place(text, sample.position[axis]);
    text += separator_;
  }
  append_number(text, sample.area_m2, !is_cell);
  text += separator_;
  append_number(text, sample.value, !is_cell && static_cast<float>(sample.value) == sample.value);
  if (!columns_.empty()) {
    const auto found = of_record_.find(sample.bits);
    text += found == of_record_.end() ? no_record_ : found->second;
  }
  text += "\r\n";
}

void TexelCsv::append_number(std::string& text, double value, bool is_single) const {
  char digits[40];
  const auto end =
      is_single ? std::to_chars(digits, digits + sizeof digits, static_cast<float>(value)).ptr
                : std::to_chars(digits, digits + sizeof digits, value).ptr;
  for (const char* c = digits; c != end; ++c) text += separator_ == ';' && *c == '.' ? ',' : *c;
}

void TexelCsv::append_place(std::string& text, double value) const {
  char digits[400];  // the largest double has 309 digits before the decimal point
  char* end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, decimals_).ptr;
  while (end[-1] == '0') --end;
  if (end[-1] == '.') --end;
  const std::string_view number(digits, static_cast<std::size_t>(end - digits));
  if (number == "-0") return void(text += '0');
  for (const char c : number) text += separator_ == ';' && c == '.' ? ',' : c;
}

}  // namespace strata::app
