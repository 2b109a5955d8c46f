#include "bill/reb_rows.h"

#include <algorithm>
#include <cstdio>

#include "core/text/printable.h"
#include "core/text/utf8.h"

namespace strata::bill {
namespace {

constexpr std::size_t kRowLength = 80, kMark = 12, kComment = 13, kCommentEnd = 68, kFormula = 29,
                      kTerm = 33, kTermEnd = 68, kAddress = 69;
constexpr std::size_t kRowsOfSheet = 26, kMaxSheet = 9999;

std::size_t bytes_of_first(std::string_view text) {
  std::size_t end = 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) ++end;
  return end;
}

// Columns are characters, which may have several bytes.
std::string row_of(std::string_view before, std::size_t column, std::string_view text,
                   const std::string& address) {
  std::string row(before);
  row.resize(column, ' ');
  row += text;
  row.append(kAddress - std::min(kAddress, column + character_count(text)), ' ');
  row += address;
  row.append(kRowLength - kAddress - address.size(), ' ');
  return row;
}

std::string with_comma(std::string number) {
  std::ranges::replace(number, '.', ',');
  return number;
}

}  // namespace

Result<std::string> RebRows::next_address() {
  const std::size_t sheet = next_ / kRowsOfSheet + 1;
  if (sheet > kMaxSheet)
    return fail(ErrorCode::invalid, "Too many rows for GAEB",
                "The proof has more rows than the addresses of REB 23.003 allow. Export parts of "
                "the bill.",
                "format");
  std::string address(6, '0');
  std::snprintf(address.data(), address.size() + 1, "%04zu%c0", sheet,
                static_cast<char>('A' + next_ % kRowsOfSheet));
  ++next_;
  return address;
}

Result<void> RebRows::add_comment(std::vector<std::string>& rows, const std::string& text) {
  std::string line = printable(text);
  std::ranges::replace(line, '\n', ' ');
  std::string_view rest = line;
  while (!rest.empty()) {
    std::size_t end = 0;
    for (std::size_t count = 0; count < kCommentEnd - kComment && end < rest.size(); ++count)
      end += bytes_of_first(rest.substr(end));
    const std::string address = STRATA_TRY(next_address());
    rows.push_back(row_of(std::string(kMark, ' ') + "*", kComment, rest.substr(0, end), address));
    rest.remove_prefix(end);
  }
  return {};
}

Result<std::vector<std::string>> RebRows::of(const Line& line, const protocol::BillItem& item) {
  const Element& element = line.element;
  std::vector<std::string> rows;
  std::string source = element.title;
  for (const std::string& part : {element.model_name, element.layer_name, line.figure, line.remark})
    if (!part.empty()) source += ", " + part;
  if (!line.user.empty()) source += ", " + line.user + " " + line.time.substr(0, 10);
  STRATA_TRY(add_comment(rows, source));
  if (line.rule > 0)
    STRATA_TRY(add_comment(rows, element.id + ": " + with_comma(element.measured.short_text()) +
                                     " " + item.unit + ", " + std::string(name(line.effect))));
  std::string term = with_comma(line.billed.short_text()) + "=";
  const auto is_plain = [](unsigned char c) { return c >= 0x20 && c < 0x7f; };
  const bool keeps_formula = line.rule == 0 && line.billed == element.measured &&
                             line.formula.size() < kTermEnd - kTerm &&
                             std::ranges::all_of(line.formula, is_plain) &&
                             line.formula.find_first_of("=xX:") == std::string::npos;
  if (keeps_formula) {
    term = with_comma(line.formula) + "=";
  } else if (!line.formula.empty()) {
    STRATA_TRY(add_comment(rows, line.formula));
  }
  const std::string address = STRATA_TRY(next_address());
  rows.push_back(row_of(std::string(kFormula, ' ') + "91", kTerm, term, address));
  return rows;
}

}  // namespace strata::bill
