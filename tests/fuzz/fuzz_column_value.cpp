// Fuzzes the value of a table's cell, first as text and then as JSON. An accepted value must be
// accepted again, unchanged, from JSON and from its own text. A value that is converted to another
// kind must be valid for that kind.
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/text/utf8.h"
#include "domain/tables/column_value.h"

namespace {

using namespace strata;

constexpr int kKinds = static_cast<int>(ColumnKind::relation) + 1;

void demand(bool holds) {
  if (!holds) std::abort();
}

Column column_of(int kind, bool required) {
  Column column;
  column.id = 1;
  column.name = column.slug = "column";
  column.kind = static_cast<ColumnKind>(kind);
  column.required = required;
  if (column.kind == ColumnKind::enumeration) column.choices = {"a", "=b", "1"};
  if (column.kind == ColumnKind::term || column.kind == ColumnKind::relation) column.target = 2;
  if (column.kind == ColumnKind::numeric) column.minimum = -1e6;
  demand(check_column(column).has_value());
  return column;
}

void check(const Column& column, const Result<nlohmann::json>& value) {
  if (!value) {
    demand(value.error().code == ErrorCode::invalid && value.error().field == "field" &&
           is_utf8(value.error().detail));
    return;
  }
  demand(!value->is_null() || !column.required);
  demand(check_value(column, *value, "field") == *value);
  demand(parse_value(column, print_value(column, *value), true, "field") == *value);
  for (int kind = 0; kind < kKinds; ++kind) {
    const Column other = column_of(kind, false);
    if (const auto converted = convert_value(column, other, *value, "field"))
      demand(check_value(other, *converted, "field") == *converted);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const Column column = column_of(data[0] % kKinds, data[1] & 1);
  const std::string_view text(reinterpret_cast<const char*>(data + 2), size - 2);
  // The CSV reader passes only UTF-8 without U+0000.
  if (is_utf8(text) && text.find('\0') == std::string_view::npos)
    check(column, parse_value(column, text, data[1] & 2, "field"));
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_discarded()) check(column, check_value(column, json, "field"));
  return 0;
}
