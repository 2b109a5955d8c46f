#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/visibility.h"
#include "domain/tables/labels.h"

namespace strata {

enum class ColumnKind {
  text,
  integer,
  numeric,
  boolean,
  date,         // YYYY-MM-DD
  timestamp,    // RFC 3339, kept in UTC
  period,       // EDTF (core/text/edtf)
  enumeration,  // one of `choices`
  url,
  term,      // the key of a record of `target`
  relation,  // keys of records of `target`: "above", "cuts", "same as"
  // ids of attachments of the table, in the order in which they are shown: pictures made of pixels
  picture,
  document,  // the same, of any files
  line,      // what the record has on models besides texels (domain/tables/mark): "cracks"
  point,     // "samples"
};
std::string_view name(ColumnKind kind);
std::optional<ColumnKind> parse_column_kind(std::string_view name);
inline bool holds_attachments(ColumnKind kind) {
  return kind == ColumnKind::picture || kind == ColumnKind::document;
}
inline bool holds_features(ColumnKind kind) {
  return kind == ColumnKind::line || kind == ColumnKind::point;
}
// Several values in one cell.
inline bool holds_lists(ColumnKind kind) {
  return kind == ColumnKind::relation || holds_attachments(kind) || holds_features(kind);
}

// A column of a project's table. Its id is given once and never again.
struct Column {
  ColumnId id = 0;
  std::string name;
  std::string slug;  // unique among the table's columns that are not hidden; never all digits
  Labels labels;
  ColumnKind kind = ColumnKind::text;
  std::string unit;  // integer and numeric
  bool required = false;
  bool unique = false;
  // null: none. New records get it where they say nothing of the column.
  nlohmann::json default_value;
  std::string comment;
  std::vector<std::string> choices;        // enumeration: at least one
  std::optional<TableId> target;           // term and relation: a table of the project
  std::optional<double> minimum, maximum;  // integer and numeric
  int order = 0;
  Visibility visibility = Visibility::everyone;
  bool hidden = false;  // dropped: its values stay for undo and for reading the past
};

// A table of a project: what the keys of database layers stand for, on any of its models.
struct Table {
  TableId id = 0;
  ProjectId project_id = 0;
  std::string name;
  std::string slug;  // unique in the project, never all digits
  Labels labels;
  std::string description;
  // those that are not hidden, by order; where it is read for somebody, those that they see
  std::vector<Column> columns;
  // id of the column that says what a record is called, as people chose it
  std::optional<ColumnId> title_column;
  std::int64_t records = 0;   // how many
  std::int64_t sequence = 0;  // of the last change of records or columns
  std::int64_t version = 1;   // of everything but the records, for ETag and If-Match
};

inline constexpr std::int64_t kMaxRecordKey = 0xffffffff;
// target of a column of a table that is being made: that table
inline constexpr TableId kOwnTable = 0;
inline constexpr int kMaxColumns = 256;
inline constexpr int kMaxChoices = 1000;
// bytes of a unit, a choice, a label, a comment
inline constexpr std::size_t kMaxColumnTextLength = 2000;

// A row: what a key stands for. `values` by column id; none where the column has none.
struct Record {
  std::int64_t key = 0;
  std::int64_t version = 1;
  std::map<ColumnId, nlohmann::json> values;
};

// What a column says of itself fits together: choices, target and limits belong to its kind, the
// default is a value of it. Puts the default into its canonical form. The field of an Error is the
// column's own ("choices", "default").
Result<void> check_column(Column& column);
Result<void> check_labels(const Labels& labels, const std::string& field = "labels");
// Texts in other languages, each of at most `longest` bytes.
Result<void> check_texts_by_language(const Labels& texts, std::size_t longest,
                                     const std::string& field);

nlohmann::json to_json(const Column& column);
nlohmann::json to_json(const Table& table);
// Takes away the columns that the role does not see.
Table seen_by(Table table, Role role);
// `{key, version, values: {slug: value}}`, with every column of `columns`.
nlohmann::json to_json(const Record& record, const std::vector<Column>& columns);

// Whether what a record has in the column can be what it is called.
bool can_be_title(const Column& column);
// The column that tells people which record it is: the one that they chose, where it is among
// `columns`; otherwise the first text that is required and unique, otherwise one that is either,
// otherwise the first column where it is a term, otherwise any text, otherwise what is unique and
// no relation; null: records have no names.
const Column* name_column(const Table& table);
// What the record is called; empty where it has no name. The key of a record of another table where
// that is what the column has.
std::string record_name(const Record& record, const Table& table);

// By id or slug; null: there is none.
const Column* find_column(const std::vector<Column>& columns, const std::string& ref);

}  // namespace strata
