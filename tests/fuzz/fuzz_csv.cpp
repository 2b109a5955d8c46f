// Fuzzes a table as CSV. Writing and reading the table must return the same cells, and its line
// numbers must ascend.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/text/csv.h"
#include "core/text/utf8.h"

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace strata;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const CsvLimits limits{200, 50};
  const auto csv = parse_csv(text, limits);
  if (!csv) {
    demand(csv.error().code == ErrorCode::invalid && is_utf8(csv.error().detail));
    return 0;
  }
  demand(csv->rows.size() <= limits.rows);
  std::string written = std::string(kUtf8Mark) + "sep=" + csv->separator + "\r\n";
  int line = 0;
  for (const auto& row : csv->rows) {
    demand(row.line > line && !row.cells.empty() && row.cells.size() <= limits.columns);
    line = row.line;
    for (const auto& cell : row.cells)
      demand(is_utf8(cell) && unguard_formula(guard_formula(cell)) == cell);
    written += csv_line(row.cells, csv->separator);
  }
  const auto again = parse_csv(written, limits);
  demand(again.has_value() && again->rows.size() == csv->rows.size());
  for (std::size_t i = 0; i < csv->rows.size(); ++i)
    demand(again->rows[i].cells == csv->rows[i].cells);
  return 0;
}
