// Fuzzes records as CSV, for a table with a column of each kind.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "app/records/record_csv.h"
#include "core/text/utf8.h"
#include "domain/tables/column_value.h"

namespace {

using namespace strata;

void demand(bool holds) {
  if (!holds) std::abort();
}

const Table& table() {
  static const Table made = [] {
    Table table;
    table.id = 7;
    table.labels = {{"es", "Hallazgos"}};
    for (int kind = 0; kind <= static_cast<int>(ColumnKind::point); ++kind) {
      Column column;
      column.id = ColumnId(std::int64_t{kind} + 1);
      column.kind = static_cast<ColumnKind>(kind);
      column.name = column.slug = std::string(name(column.kind));
      column.order = kind;
      if (column.kind == ColumnKind::enumeration) column.choices = {"one", "two"};
      if (column.kind == ColumnKind::term || column.kind == ColumnKind::relation)
        column.target = TableId(8);
      table.columns.push_back(column);
    }
    return table;
  }();
  return made;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto rows = app::read_records_csv(text, table());
  if (!rows) {
    demand(!is_server_failure(rows.error().code) && is_utf8(rows.error().detail));
    return 0;
  }
  demand(rows->records.size() == rows->lines.size() && rows->records.size() <= rows->rows);
  demand(rows->mistakes.size() <= 100);
  for (const auto& mistake : rows->mistakes) demand(is_utf8(mistake.problem.detail));
  for (const auto& record : rows->records)
    for (const auto& [id, value] : record.values) {
      const Column* column = find_column(table().columns, to_string(id));
      demand(column && (value.is_null() || check_value(*column, value, "values").has_value()));
    }
  return 0;
}
