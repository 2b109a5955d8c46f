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
  timestamp,    // RFC 3339, stored in UTC
  period,       // EDTF (core/text/edtf)
  enumeration,  // one of `choices`
  url,
  term,      // the key of a record of `target`
  relation,  // keys of records of `target`: "above", "cuts", "same as"
  // Ids of attachments of the table that are raster images, in the order of display.
  picture,
  document,  // ids of attachments of any type, in the order of display
  line,      // lines on models (domain/tables/surface_feature): "cracks"
  point,     // points on models: "samples"
};
std::string_view name(ColumnKind kind);
std::optional<ColumnKind> parse_column_kind(std::string_view name);
inline bool holds_attachments(ColumnKind kind) {
  return kind == ColumnKind::picture || kind == ColumnKind::document;
}
inline bool holds_features(ColumnKind kind) {
  return kind == ColumnKind::line || kind == ColumnKind::point;
}
// Returns whether one cell holds several values.
inline bool holds_lists(ColumnKind kind) {
  return kind == ColumnKind::relation || holds_attachments(kind) || holds_features(kind);
}

// A column of a project's table. The id of a column is never used again.
struct Column {
  ColumnId id = 0;
  std::string name;
  std::string slug;  // unique among the table's columns that are not hidden; never all digits
  Labels labels;
  ColumnKind kind = ColumnKind::text;
  std::string unit;  // integer and numeric
  bool required = false;
  bool unique = false;
  // The value for new records that have no value in the column. Null: no default.
  nlohmann::json default_value;
  std::string comment;
  std::vector<std::string> choices;        // enumeration: at least one
  std::optional<TableId> target;           // term and relation: a table of the project
  std::optional<double> minimum, maximum;  // integer and numeric
  int order = 0;
  Visibility visibility = Visibility::everyone;
  bool hidden = false;  // dropped; the values stay for undo and for past states of the table
};

// A table of a project. It holds the records for the keys in database layers, on all models of the
// project.
struct Table {
  TableId id = 0;
  ProjectId project_id = 0;
  std::string name;
  std::string slug;  // unique in the project, never all digits
  Labels labels;
  std::string description;
  // Sorted by `order`, without hidden columns. A user gets only the columns that the user sees.
  std::vector<Column> columns;
  // The column that was chosen for the names of the records.
  std::optional<ColumnId> title_column;
  std::int64_t records = 0;   // number of records
  std::int64_t sequence = 0;  // of the last change to records or columns
  std::int64_t version = 1;   // of everything except the records; for ETag and If-Match
};

inline constexpr std::int64_t kMaxRecordKey = 0xffffffff;
// The target of a column that refers to its own table, while the new table has no id.
inline constexpr TableId kOwnTable = 0;
inline constexpr int kMaxColumns = 256;
inline constexpr int kMaxChoices = 1000;
// The maximum bytes of a unit, a choice, a label or a comment.
inline constexpr std::size_t kMaxColumnTextLength = 2000;

// A row with its key. `values` contains the values by column id. A missing entry means no value.
struct Record {
  std::int64_t key = 0;
  std::int64_t version = 1;
  std::map<ColumnId, nlohmann::json> values;
};

// Checks that the properties of a column are consistent: its kind allows its choices, target and
// limits, and the default is a valid value. Normalizes the default. The Error contains the field of
// the column ("choices", "default").
Result<void> check_column(Column& column);
Result<void> check_labels(const Labels& labels, const std::string& field = "labels");
// Checks texts in other languages, each of at most `longest` bytes.
Result<void> check_texts_by_language(const Labels& texts, std::size_t longest,
                                     const std::string& field);

nlohmann::json to_json(const Column& column);
nlohmann::json to_json(const Table& table);
// Removes the columns that the role does not see.
Table seen_by(Table table, Role role);
// Returns `{key, version, values: {slug: value}}`, with all columns in `columns`.
nlohmann::json to_json(const Record& record, const std::vector<Column>& columns);

// Returns whether the column can name records.
bool can_be_title(const Column& column);
// Returns the column that names the records, or null without such a column. This is the chosen
// column if it is in `columns`. Otherwise it is the first match in this order: a text that is
// required and unique, a text that is required or unique, the first column if it holds terms, any
// text, a unique column without a target.
const Column* name_column(const Table& table);
// Returns the name of the record. Empty if it has no name. If the column holds keys of another
// table, returns the key.
std::string record_name(const Record& record, const Table& table);

// Finds a column by id or slug. Returns null if it does not exist.
const Column* find_column(const std::vector<Column>& columns, const std::string& ref);

}  // namespace strata
