#include "app/records/record_csv.h"

#include <algorithm>
#include <array>
#include <set>

#include "core/text/ascii.h"
#include "core/text/csv.h"
#include "core/text/number_text.h"
#include "domain/tables/column_value.h"

namespace strata::app {
namespace {

constexpr const char* kKey = "key";
constexpr const char* kVersion = "version";
// The names in RecordMeasures.
constexpr std::array<std::string_view, 3> kMeasures = {"area_m2", "length_m", "point_count"};

std::string with_comma(std::string number) {
  std::replace(number.begin(), number.end(), '.', ',');
  return number;
}

bool is_measure(const std::string& head) {
  return std::ranges::find(kMeasures, head) != kMeasures.end();
}

bool is_called(const Column& column, const std::string& head) {
  if (column.slug == head || column.name == head) return true;
  return std::any_of(column.labels.begin(), column.labels.end(),
                     [&](const auto& label) { return label.second == head; });
}

// A cell of the first row: the name of a column of the table, or a special name.
struct Head {
  std::string text;
  const Column* column = nullptr;
};

Result<std::vector<Head>> read_heads(const CsvRow& row, const Table& table) {
  std::vector<Head> heads;
  std::set<std::string> met;
  for (const std::string& cell : row.cells) {
    Head head{std::string(trimmed(cell)), nullptr};
    const bool is_word = head.text == kKey || head.text == kVersion;
    if (!is_word)
      for (const Column& column : table.columns)
        if (is_called(column, head.text)) {
          head.column = &column;
          break;
        }
    if (!is_word && !head.column && !is_measure(head.text))
      return fail(ErrorCode::invalid, "Unknown column",
                  table.name + " has no column \"" + head.text +
                      "\". The first row must contain slugs, names or labels of columns, and may "
                      "contain `key`.",
                  "body");
    if (!met.insert(head.column ? to_string(head.column->id) : head.text).second)
      return fail(ErrorCode::invalid, "Duplicate column",
                  "\"" + head.text + "\" appears twice in the first row.", "body");
    heads.push_back(std::move(head));
  }
  return heads;
}

}  // namespace

std::optional<std::string> term_word(const Record& record, const Column& column,
                                     const WordsOfTables& words) {
  if (column.kind != ColumnKind::term || !column.target) return std::nullopt;
  const auto known = words.find(*column.target);
  const auto value = record.values.find(column.id);
  if (known == words.end() || value == record.values.end() || value->second.is_null())
    return std::nullopt;
  return known->second.word(value->second.get<std::int64_t>());
}

std::string record_cell(const Record& record, const Column& column, char separator,
                        const WordsOfTables& words) {
  const auto value = record.values.find(column.id);
  if (value == record.values.end()) return {};
  if (auto word = term_word(record, column, words)) return guard_formula(std::move(*word));
  std::string cell = print_value(column, value->second);
  return separator == ';' && column.kind == ColumnKind::numeric ? with_comma(std::move(cell))
                                                                : cell;
}

std::string records_csv(const std::vector<Record>& records, const std::vector<Column>& columns,
                        const MeasuredRecords& measured, char separator,
                        const WordsOfTables& words) {
  std::string text(kUtf8Mark);
  std::vector<std::string> cells{kKey};
  for (const Column& column : columns) cells.push_back(column.slug);
  cells.insert(cells.end(), measured.names.begin(), measured.names.end());
  text += csv_line(cells, separator);
  for (std::size_t i = 0; i < records.size(); ++i) {
    cells = {std::to_string(records[i].key)};
    for (const Column& column : columns)
      cells.push_back(record_cell(records[i], column, separator, words));
    if (!measured.names.empty())
      for (const double value : measured.values[i]) cells.push_back(csv_number(value, separator));
    text += csv_line(cells, separator);
  }
  return text;
}

namespace {

Result<nlohmann::json> read_cell(const Column& column, const std::string& cell, bool comma,
                                 const std::string& field, const WordsOfTables& words) {
  const auto known =
      column.kind == ColumnKind::term && column.target ? words.find(*column.target) : words.end();
  if (known == words.end() || trimmed(cell).empty()) return parse_value(column, cell, comma, field);
  const auto key = known->second.key_of(unguard_formula(std::string(trimmed(cell))), field);
  if (!key) return tl::unexpected(key.error());
  return check_value(column, *key, field);
}

}  // namespace

Result<RecordRows> read_records_csv(std::string_view text, const Table& table,
                                    const WordsOfTables& words) {
  auto csv =
      parse_csv(text, {store::kMaxRecordsAtOnce + 1, static_cast<std::size_t>(kMaxColumns) + 3});
  if (!csv) return tl::unexpected(csv.error());
  if (csv->rows.empty())
    return fail(ErrorCode::invalid, "Empty table",
                "The text is empty. Its first row must contain the column names.", "body");
  auto heads = read_heads(csv->rows.front(), table);
  if (!heads) return tl::unexpected(heads.error());
  const bool comma = csv->separator == ';';
  RecordRows out;
  for (const Head& head : *heads)
    if (head.column) out.heads[head.column->id] = head.text;
  out.rows = csv->rows.size() - 1;
  for (std::size_t r = 1; r < csv->rows.size(); ++r) {
    const CsvRow& row = csv->rows[r];
    std::vector<RowMistake> mistakes;
    store::RecordInput record;
    if (row.cells.size() != heads->size())
      mistakes.push_back(
          {row.line,
           {},
           {ErrorCode::invalid,
            "Wrong number of cells",
            "The row has " + std::to_string(row.cells.size()) + " cells, but the first row has " +
                std::to_string(heads->size()) + ".",
            {}}});
    for (std::size_t c = 0; c < std::min(row.cells.size(), heads->size()); ++c) {
      const Head& head = (*heads)[c];
      const std::string& cell = row.cells[c];
      if (head.column) {
        auto value = read_cell(*head.column, cell, comma, head.text, words);
        if (!value)
          mistakes.push_back({row.line, head.text, value.error()});
        else
          record.values[head.column->id] = std::move(*value);
      } else if (!is_measure(head.text) && !trimmed(cell).empty()) {
        const bool is_key = head.text == kKey;
        auto number =
            parse_integer(trimmed(cell), 0, is_key ? kMaxRecordKey : INT64_MAX, head.text);
        if (!number)
          mistakes.push_back({row.line, head.text, number.error()});
        else
          (is_key ? record.key : record.version) = *number;
      }
    }
    if (mistakes.empty()) {
      out.records.push_back(std::move(record));
      out.lines.push_back(row.line);
    }
    for (RowMistake& mistake : mistakes)
      if (out.mistakes.size() < store::kMaxRowProblems) out.mistakes.push_back(std::move(mistake));
  }
  return out;
}

}  // namespace strata::app
