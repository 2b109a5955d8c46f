#include "core/text/csv.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/text/utf8.h"

namespace strata {
namespace {

constexpr std::array kSeparators = {',', ';', '\t'};

bool ends_row(char c) { return c == '\n' || c == '\r'; }

char guess_separator(std::string_view text) {
  std::array<int, kSeparators.size()> count{};
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (ends_row(c)) break;
    for (std::size_t i = 0; i < kSeparators.size(); ++i) count[i] += c == kSeparators[i];
  }
  return kSeparators[static_cast<std::size_t>(std::max_element(count.begin(), count.end()) -
                                              count.begin())];
}

class Reader {
 public:
  Reader(std::string_view text, const CsvLimits& limits) : rest_(text), limits_(limits) {}

  Result<CsvText> read() {
    if (rest_.starts_with("\xff\xfe") || rest_.starts_with("\xfe\xff"))
      return fail(ErrorCode::invalid, "Not UTF-8",
                  "The text is encoded as UTF-16. Save it as \"CSV UTF-8\".", "body");
    if (rest_.starts_with(kUtf8Mark)) rest_.remove_prefix(kUtf8Mark.size());
    if (rest_.size() >= 5 && rest_.starts_with("sep=") &&
        (rest_.size() == 5 || ends_row(rest_[5]))) {
      out_.separator = rest_[4];
      rest_.remove_prefix(5);
      take_row_end();
    } else {
      out_.separator = guess_separator(rest_);
    }
    if (std::find(kSeparators.begin(), kSeparators.end(), out_.separator) == kSeparators.end())
      return refuse("The separator must be a comma, a semicolon or a tab");
    while (!rest_.empty()) STRATA_TRY(read_row());
    return std::move(out_);
  }

 private:
  tl::unexpected<Error> refuse(const std::string& why) const {
    return fail(ErrorCode::invalid, "Not CSV", why + " (line " + std::to_string(line_) + ").",
                "body");
  }

  void take_row_end() {
    if (rest_.empty()) return;
    const bool two = rest_.starts_with("\r\n");
    rest_.remove_prefix(two ? 2 : 1);
    ++line_;
  }

  Result<void> read_row() {
    CsvRow row{line_, {}};
    for (bool more = true; more;) {
      if (row.cells.size() == limits_.columns)
        return refuse("A row can have at most " + std::to_string(limits_.columns) + " cells");
      auto cell = STRATA_TRY(rest_.starts_with('"') ? quoted_cell() : bare_cell());
      if (!is_utf8(cell))
        return refuse("A cell is not encoded as UTF-8; save the text as \"CSV UTF-8\"");
      if (cell.find('\0') != std::string::npos) return refuse("A cell contains U+0000");
      row.cells.push_back(std::move(cell));
      more = rest_.starts_with(out_.separator);
      if (more) rest_.remove_prefix(1);
    }
    take_row_end();
    if (std::all_of(row.cells.begin(), row.cells.end(),
                    [](const auto& cell) { return cell.empty(); }))
      return {};
    if (out_.rows.size() == limits_.rows)
      return refuse("A CSV text can have at most " + std::to_string(limits_.rows) + " rows");
    out_.rows.push_back(std::move(row));
    return {};
  }

  Result<std::string> bare_cell() {
    std::size_t end = 0;
    while (end < rest_.size() && rest_[end] != out_.separator && !ends_row(rest_[end])) ++end;
    std::string cell(rest_.substr(0, end));
    rest_.remove_prefix(end);
    return cell;
  }

  Result<std::string> quoted_cell() {
    std::string cell;
    rest_.remove_prefix(1);
    for (;;) {
      const std::size_t quote = rest_.find('"');
      if (quote == std::string_view::npos) return refuse("A quoted cell has no closing quote");
      const std::string_view part = rest_.substr(0, quote);
      for (std::size_t i = 0; i < part.size(); ++i)
        line_ +=
            part[i] == '\n' || (part[i] == '\r' && (i + 1 == part.size() || part[i + 1] != '\n'));
      cell += part;
      rest_.remove_prefix(quote + 1);
      if (!rest_.starts_with('"')) break;
      cell += '"';
      rest_.remove_prefix(1);
    }
    if (!rest_.empty() && rest_[0] != out_.separator && !ends_row(rest_[0]))
      return refuse("Text follows the closing quote of a cell; write a quote inside a cell twice");
    return cell;
  }

  std::string_view rest_;
  const CsvLimits limits_;
  int line_ = 1;
  CsvText out_;
};

// A reader with another separator, or one that ignores quotes, begins a cell after any of these
// characters.
constexpr std::string_view kCellEnds = ",;\t\r\n";
constexpr std::array<std::string_view, 8> kFormulaBegins = {"=",      "+",      "-",      "@",
                                                            "\uff1d", "\uff0b", "\uff0d", "\uff20"};

// Ignores leading apostrophes and quotes, because a reader removes the quotes.
bool begins_formula(std::string_view cell) {
  cell.remove_prefix(std::min(cell.find_first_not_of("'\""), cell.size()));
  return std::ranges::any_of(kFormulaBegins,
                             [&](std::string_view begin) { return cell.starts_with(begin); });
}

// Some readers remove a leading tab or CR and evaluate the rest.
bool begins_formula(std::string_view text, std::size_t at) {
  if (begins_formula(text.substr(at))) return true;
  const std::size_t first = at == 0 ? text.find_first_not_of("'\"") : std::string_view::npos;
  return first != std::string_view::npos && (text[first] == '\t' || text[first] == '\r');
}

// Calls `visit` at the beginning of the text and of each part that another reader may read as a
// cell.
template <class Visit>
void for_each_cell_begin(std::string_view text, Visit visit) {
  for (std::size_t at = 0;; ++at) {
    visit(at);
    at = text.find_first_of(kCellEnds, at);
    if (at == std::string_view::npos) return;
  }
}

// Also quotes cells with other separators, because some readers accept several separators. Does not
// quote a number with a decimal comma, because some readers treat quoted numbers as text.
bool needs_quotes(std::string_view cell, char separator) {
  if (cell.find_first_of("\"\r\n") != std::string_view::npos ||
      cell.find(separator) != std::string_view::npos)
    return true;
  if (cell.starts_with(' ') || cell.ends_with(' ')) return true;
  const bool is_number = cell.find_first_not_of("0123456789,.+-eE") == std::string_view::npos;
  return !is_number && cell.find_first_of(kCellEnds) != std::string_view::npos;
}

}  // namespace

Result<CsvText> parse_csv(std::string_view text, const CsvLimits& limits) {
  return Reader(text, limits).read();
}

void append_csv_cell(std::string& line, std::string_view cell, char separator) {
  if (!needs_quotes(cell, separator)) {
    line += cell;
    return;
  }
  line += '"';
  for (const char c : cell) {
    if (c == '"') line += '"';
    line += c;
  }
  line += '"';
}

std::string csv_line(const std::vector<std::string>& cells, char separator) {
  // Readers ignore a row that looks empty.
  if (cells.size() == 1 && cells.front().empty()) return "\"\"\r\n";
  std::string line;
  for (const std::string& cell : cells) {
    if (&cell != cells.data()) line += separator;
    append_csv_cell(line, cell, separator);
  }
  return line + "\r\n";
}

std::string csv_number(double value, char separator) {
  char text[40];
  std::string number(text, std::to_chars(text, text + sizeof text, value).ptr);
  if (separator == ';') std::ranges::replace(number, '.', ',');
  return number;
}

std::string guard_formula(std::string text) {
  std::string guarded;
  std::size_t copied = 0;
  for_each_cell_begin(text, [&](std::size_t at) {
    if (!begins_formula(text, at)) return;
    guarded.append(text, copied, at - copied) += '\'';
    copied = at;
  });
  if (copied == 0 && guarded.empty()) return text;
  return guarded.append(text, copied);
}

std::string unguard_formula(std::string text) {
  std::string plain;
  std::size_t copied = 0;
  for_each_cell_begin(text, [&](std::size_t at) {
    if (at == text.size() || text[at] != '\'' || !begins_formula(text, at)) return;
    plain.append(text, copied, at - copied);
    copied = at + 1;
  });
  if (copied == 0) return text;
  return plain.append(text, copied);
}

}  // namespace strata
