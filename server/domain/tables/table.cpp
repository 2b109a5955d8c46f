#include "domain/tables/table.h"

#include <algorithm>
#include <array>
#include <set>

#include "core/text/slug.h"
#include "core/text/utf8.h"
#include "domain/tables/column_value.h"
#include "domain/tables/term_list.h"

namespace strata {
namespace {

constexpr std::array<std::string_view, 15> kKindNames = {
    "text", "integer", "numeric",  "boolean", "date",     "timestamp", "period", "enumeration",
    "url",  "term",    "relation", "picture", "document", "line",      "point"};
static_assert(kKindNames.size() == static_cast<std::size_t>(ColumnKind::point) + 1 &&
                  !kKindNames.back().empty(),
              "each kind has its name, in the order of ColumnKind");

bool is_number(ColumnKind kind) {
  return kind == ColumnKind::integer || kind == ColumnKind::numeric;
}
bool names_records(ColumnKind kind) {
  return kind == ColumnKind::term || kind == ColumnKind::relation;
}

bool is_language_tag(std::string_view tag) {
  if (tag.empty() || tag.size() > 35 || tag.front() == '-' || tag.back() == '-') return false;
  return std::all_of(tag.begin(), tag.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
  });
}

Result<void> check_short(const std::string& text, const std::string& field,
                         std::size_t longest = kMaxColumnTextLength) {
  if (text.size() <= longest && is_utf8(text) && text.find('\0') == std::string::npos) return {};
  return fail(ErrorCode::invalid, "Invalid text",
              "`" + field + "` must be UTF-8 text of at most " + std::to_string(longest) +
                  " bytes, without U+0000.",
              field);
}

Result<void> check_choices(const Column& column) {
  if (column.kind != ColumnKind::enumeration) {
    if (column.choices.empty()) return {};
    return fail(ErrorCode::invalid, "Choices without enumeration",
                "Only columns of kind `enumeration` can have choices.", "choices");
  }
  if (column.choices.empty() || column.choices.size() > kMaxChoices)
    return fail(ErrorCode::invalid, "Invalid choices",
                "An enumeration must have 1 to " + std::to_string(kMaxChoices) + " choices.",
                "choices");
  std::set<std::string> known;
  for (const std::string& choice : column.choices) {
    STRATA_TRY(check_short(choice, "choices"));
    if (choice.empty() || !known.insert(choice).second)
      return fail(
          ErrorCode::invalid, "Invalid choices",
          "Choices must not be empty, and each choice must appear only once: \"" + choice + "\".",
          "choices");
  }
  return {};
}

Result<void> check_limits(const Column& column) {
  if (!is_number(column.kind)) {
    if (!column.unit.empty())
      return fail(ErrorCode::invalid, "Unit without number",
                  "Only columns of numbers can have a unit.", "unit");
    if (column.minimum)
      return fail(ErrorCode::invalid, "Limit without number",
                  "Only columns of numbers can have a minimum.", "minimum");
    if (column.maximum)
      return fail(ErrorCode::invalid, "Limit without number",
                  "Only columns of numbers can have a maximum.", "maximum");
    return {};
  }
  if (column.minimum && column.maximum && *column.minimum > *column.maximum)
    return fail(ErrorCode::invalid, "Minimum above maximum",
                "`minimum` must not be greater than `maximum`.", "minimum");
  return {};
}

Result<void> check_kind(const Column& column) {
  if (names_records(column.kind) != column.target.has_value())
    return names_records(column.kind)
               ? fail(ErrorCode::invalid, "Target missing",
                      "A column of this kind needs a table of the project as `target`.", "target")
               : fail(ErrorCode::invalid, "Target without relation",
                      "Only columns of kind `term` or `relation` can have a target.", "target");
  if ((holds_attachments(column.kind) || holds_features(column.kind)) &&
      !column.default_value.is_null())
    return fail(
        ErrorCode::invalid, "Default not allowed",
        holds_features(column.kind)
            ? "Columns of lines and points cannot have a default value, because people draw them "
              "for each record."
            : "Columns of files cannot have a default value, because people attach files to each "
              "record.",
        "default");
  if (column.unique && (column.kind == ColumnKind::boolean || holds_lists(column.kind)))
    return fail(ErrorCode::invalid, "Cannot be unique",
                "Columns of kind `" + std::string(name(column.kind)) +
                    "` cannot be unique, because several records can have the same value.",
                "unique");
  if (column.unique && !column.default_value.is_null())
    return fail(ErrorCode::invalid, "Unique column with default",
                "A unique column cannot have a default value, because only one record can have "
                "each value.",
                "default");
  return {};
}

}  // namespace

std::string_view name(ColumnKind kind) { return kKindNames[static_cast<std::size_t>(kind)]; }

std::optional<ColumnKind> parse_column_kind(std::string_view name) {
  const auto found = std::find(kKindNames.begin(), kKindNames.end(), name);
  if (found == kKindNames.end()) return std::nullopt;
  return static_cast<ColumnKind>(found - kKindNames.begin());
}

Result<void> check_labels(const Labels& labels, const std::string& field) {
  return check_texts_by_language(labels, kMaxColumnTextLength, field);
}

Result<void> check_texts_by_language(const Labels& texts, std::size_t longest,
                                     const std::string& field) {
  if (texts.size() > 100)
    return fail(ErrorCode::invalid, "Too many labels", "Send at most 100 labels.", field);
  for (const auto& [tag, text] : texts) {
    if (!is_language_tag(tag))
      return fail(
          ErrorCode::invalid, "Invalid language",
          "\"" + mended_utf8(tag) + "\" is not a language tag. Send a tag such as `es` or `pt-BR`.",
          field);
    STRATA_TRY(check_short(text, field + "." + tag, longest));
  }
  return {};
}

Result<void> check_column(Column& column) {
  if (column.name.empty())
    return fail(ErrorCode::invalid, "Invalid name",
                "The name of a column must be 1 to " + std::to_string(kMaxColumnTextLength) +
                    " bytes long.",
                "name");
  STRATA_TRY(check_short(column.name, "name"));
  STRATA_TRY(check_short(column.unit, "unit"));
  STRATA_TRY(check_short(column.comment, "comment"));
  STRATA_TRY(check_labels(column.labels));
  STRATA_TRY(check_choices(column));
  STRATA_TRY(check_limits(column));
  STRATA_TRY(check_kind(column));
  // Annotators write records, so they must be able to fill a required column.
  if (column.required && column.visibility == Visibility::curators &&
      column.default_value.is_null())
    return fail(ErrorCode::invalid, "Required but private column",
                "People who cannot see this column could not create records. Set a default value, "
                "or allow empty values.",
                "visibility");
  if (column.default_value.is_null()) return {};
  auto value = STRATA_TRY(check_value(column, column.default_value, "default"));
  column.default_value = std::move(value);
  return {};
}

nlohmann::json to_json(const Column& column) {
  nlohmann::json json{{"id", column.id},           {"name", column.name},
                      {"slug", column.slug},       {"labels", column.labels},
                      {"kind", name(column.kind)}, {"required", column.required},
                      {"unique", column.unique},   {"comment", column.comment},
                      {"order", column.order},     {"visibility", name(column.visibility)}};
  if (is_number(column.kind)) json["unit"] = column.unit;
  if (!column.default_value.is_null()) json["default"] = column.default_value;
  if (column.kind == ColumnKind::enumeration) json["choices"] = column.choices;
  if (column.target) json["target"] = *column.target;
  if (column.minimum) json["minimum"] = *column.minimum;
  if (column.maximum) json["maximum"] = *column.maximum;
  return json;
}

Table seen_by(Table table, Role role) {
  std::erase_if(table.columns,
                [role](const Column& column) { return !sees(role, column.visibility); });
  return table;
}

nlohmann::json to_json(const Table& table) {
  nlohmann::json columns = nlohmann::json::array();
  for (const Column& column : table.columns) columns.push_back(to_json(column));
  nlohmann::json json{{"id", table.id},
                      {"project", table.project_id},
                      {"name", table.name},
                      {"slug", table.slug},
                      {"kind", term_columns(table) ? "terms" : "records"},
                      {"labels", table.labels},
                      {"description", table.description},
                      {"columns", std::move(columns)},
                      {"records", table.records},
                      {"sequence", table.sequence}};
  // Omits a column that the user cannot see or that was dropped.
  if (table.title_column &&
      std::ranges::find(table.columns, *table.title_column, &Column::id) != table.columns.end())
    json["title_column"] = *table.title_column;
  return json;
}

nlohmann::json to_json(const Record& record, const std::vector<Column>& columns) {
  nlohmann::json values = nlohmann::json::object();
  for (const Column& column : columns) {
    const auto found = record.values.find(column.id);
    values[column.slug] = found == record.values.end() ? nlohmann::json() : found->second;
  }
  return {{"key", record.key}, {"version", record.version}, {"values", std::move(values)}};
}

bool can_be_title(const Column& column) {
  return !holds_lists(column.kind) && column.kind != ColumnKind::boolean && !column.hidden;
}

const Column* name_column(const Table& table) {
  const std::vector<Column>& columns = table.columns;
  if (table.title_column) {
    const auto chosen = std::ranges::find(columns, *table.title_column, &Column::id);
    if (chosen != columns.end() && can_be_title(*chosen)) return &*chosen;
  }
  const auto first = [&](auto fits) {
    const auto found = std::ranges::find_if(columns, fits);
    return found == columns.end() ? nullptr : &*found;
  };
  const auto is_text = [](const Column& column) { return column.kind == ColumnKind::text; };
  const Column* found =
      first([&](const Column& c) { return is_text(c) && c.required && c.unique; });
  if (!found)
    found = first([&](const Column& c) { return is_text(c) && (c.required || c.unique); });
  // A first column of terms names the observed object. A text may name the observer instead.
  if (!found && !columns.empty() && columns.front().kind == ColumnKind::term)
    found = &columns.front();
  if (!found) found = first(is_text);
  if (!found) found = first([](const Column& c) { return c.unique && !c.target; });
  return found;
}

std::string record_name(const Record& record, const Table& table) {
  const Column* column = name_column(table);
  const auto found = column ? record.values.find(column->id) : record.values.end();
  if (found == record.values.end() || found->second.is_null()) return {};
  return found->second.is_string() ? found->second.get<std::string>() : found->second.dump();
}

const Column* find_column(const std::vector<Column>& columns, const std::string& ref) {
  const bool by_id = is_all_digits(ref);
  for (const Column& column : columns)
    if (by_id ? to_string(column.id) == ref : column.slug == ref) return &column;
  return nullptr;
}

}  // namespace strata
