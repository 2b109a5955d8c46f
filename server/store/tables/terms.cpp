#include <algorithm>

#include "domain/tables/column_value.h"
#include "domain/tables/relation_cycles.h"
#include "domain/tables/term_list.h"
#include "store/store_impl.h"
#include "store/tables/table_rows.h"
#include "store/tables/table_writer.h"
#include "store/tables/tables.h"

namespace strata::store {
namespace {

nlohmann::json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::json() : nlohmann::json(text);
}

// Imports terms into a term list: finds the record of each term, and converts the changes to cells.
class TermIntake {
 public:
  TermIntake(PgConnection& connection, OpenTable& open, const TermList& list)
      : connection_(connection), open_(open), list_(list) {}

  Result<TableChange> take(const std::string& user, const std::string& op) {
    edit_.user = user;
    edit_.op = op;
    STRATA_TRY(add_columns());
    STRATA_TRY(find_keys());
    for (std::size_t i = 0; i < list_.terms.size(); ++i)
      if (auto good = add_cells(i); !good) add_problem(i, good.error());
    refuse_circles();
    TableChange change;
    change.table = open_.table;
    change.problems = std::move(problems_);
    if (!change.problems.empty()) return change;
    std::erase_if(edit_.records, [](const auto& record) { return record.second.empty(); });
    if (edit_.records.empty() && edit_.columns.empty()) return change;
    edit_.record = {{"records", edit_.records.size()}, {"terms", list_.terms.size()}};
    auto done = STRATA_TRY(apply_edit(connection_, open_, std::move(edit_)));
    for (RowError& problem : done.problems)
      if (const auto index = index_of_.find(problem.key); index != index_of_.end())
        problem.index = index->second;
    return done;
  }

 private:
  // Adds the columns that are in the text but not in the list, in the same entry as the terms.
  Result<void> add_columns() {
    // New columns are hidden until the edit shows them. They are also added to `open_.all`, where
    // written columns are searched.
    for (const Column& column : open_.table.columns) columns_[column.slug] = column;
    for (const std::string& slug : list_.columns) {
      if (columns_.contains(slug)) continue;
      Column column = new_term_column(slug);
      STRATA_TRY(fit_column(connection_, open_, column));
      for (const auto& [other, known] : columns_)
        column.order = std::max(column.order, known.order + 1);
      auto made = STRATA_TRY(insert_column(connection_, open_, std::move(column)));
      open_.all.push_back(made);
      edit_.columns[made.id] = {{"hidden", false}};
      columns_[slug] = std::move(made);
    }
    return {};
  }

  // Finds the record of each term, by URI or else by code. A term without a record gets a new one.
  Result<void> find_keys() {
    auto rows = STRATA_TRY(load_all_rows(connection_, open_.table.id, open_.all));
    for (Record& row : rows) {
      if (const std::string code = held_text(row, "code"); !code.empty())
        key_of_code_[code] = row.key;
      if (const std::string uri = held_text(row, "uri"); !uri.empty())
        key_of_uri_.emplace(uri, row.key);
      now_[row.key] = std::move(row);
    }
    std::int64_t next = open_.next_key;
    std::set<std::string> uris;
    for (std::size_t i = 0; i < list_.terms.size(); ++i) {
      const Term& term = list_.terms[i];
      const auto by_uri = term.uri.empty() ? key_of_uri_.end() : key_of_uri_.find(term.uri);
      const auto by_code = key_of_code_.find(term.code);
      std::int64_t key = 0;
      if (by_uri != key_of_uri_.end())
        key = by_uri->second;
      else if (by_code != key_of_code_.end())
        key = by_code->second;
      else if (next > kMaxRecordKey)
        return fail(ErrorCode::conflict, "No keys left", "All keys up to 4294967295 are used.",
                    "key");
      else
        key = next++;
      if (const auto [first, is_new] = index_of_.emplace(key, i); !is_new)
        add_problem(i,
                    {ErrorCode::invalid, "Duplicate term",
                     "\"" + term.code + "\" and \"" + list_.terms[first->second].code +
                         "\" are the same term of the list: one by its URI, the other by its code. "
                         "Correct the URI or the code.",
                     "uri"});
      keys_.push_back(key);
      if (!term.uri.empty() && !uris.insert(term.uri).second)
        add_problem(i, {ErrorCode::invalid, "Duplicate URI",
                        "Two terms have this URI: " + term.uri.substr(0, 300) + ".", "uri"});
    }
    // After this, codes and URIs refer to the changed records, because a term may get the code that
    // another term loses.
    for (const auto& [key, index] : index_of_) {
      const auto held = now_.find(key);
      if (held == now_.end()) continue;
      if (const auto code = key_of_code_.find(held_text(held->second, "code"));
          code != key_of_code_.end() && code->second == key)
        key_of_code_.erase(code);
    }
    for (std::size_t i = 0; i < list_.terms.size(); ++i) {
      key_of_code_[list_.terms[i].code] = keys_[i];
      if (!list_.terms[i].uri.empty()) key_of_uri_[list_.terms[i].uri] = keys_[i];
    }
    return {};
  }

  Result<void> add_cells(std::size_t index) {
    const Term& term = list_.terms[index];
    const std::int64_t key = keys_[index];
    const auto held = now_.find(key);
    const bool exists = held != now_.end();
    Cells& cells = edit_.records[key];
    if (!exists) cells["exists"] = true;
    if (!exists)
      for (const Column& column : open_.table.columns)
        if (!column.default_value.is_null()) cells[to_string(column.id)] = column.default_value;
    for (const std::string& slug : list_.columns) {
      auto value = STRATA_TRY(value_of(term, slug));
      const Column& column = columns_.at(slug);
      STRATA_TRY(check_value(column, value, slug));
      nlohmann::json now;
      if (exists)
        if (const auto cell = held->second.values.find(column.id);
            cell != held->second.values.end())
          now = cell->second;
      if (value != now || !exists) cells[to_string(column.id)] = std::move(value);
    }
    return {};
  }

  Result<nlohmann::json> value_of(const Term& term, const std::string& slug) {
    if (slug == "code") return text_or_null(term.code);
    if (slug == "label") return text_or_null(term.label);
    if (slug == "definition") return text_or_null(term.definition);
    if (slug == "uri") return text_or_null(term.uri);
    if (slug == "color") return text_or_null(term.color);
    if (slug == "pattern") return text_or_null(term.pattern);
    if (slug != "parent") {
      const auto label = term.labels.find(*label_language(slug));
      return label == term.labels.end() ? nlohmann::json() : nlohmann::json(label->second);
    }
    if (!term.parent.empty()) {
      const auto parent = key_of_code_.find(term.parent);
      if (parent == key_of_code_.end())
        return fail(ErrorCode::invalid, "Parent not found",
                    "Neither the list nor the file has a term \"" + term.parent + "\".", "parent");
      return nlohmann::json(parent->second);
    }
    // A vocabulary may be part of another vocabulary with terms that are not in the list.
    const auto parent =
        term.parent_uri.empty() ? key_of_uri_.end() : key_of_uri_.find(term.parent_uri);
    return parent == key_of_uri_.end() ? nlohmann::json() : nlohmann::json(parent->second);
  }

  // Refuses a term that is below itself in the tree, also through terms that are already in the
  // list.
  void refuse_circles() {
    const ColumnId column = columns_.at("parent").id;
    Relation relation;
    const auto name = [&](std::int64_t key, const nlohmann::json& parent) {
      if (parent.is_number()) relation[key] = {parent.get<std::int64_t>()};
    };
    for (const auto& [key, row] : now_)
      if (const auto parent = row.values.find(column); parent != row.values.end())
        name(key, parent->second);
    for (const auto& [key, cells] : edit_.records)
      if (const auto parent = cells.find(to_string(column)); parent != cells.end()) {
        relation.erase(key);
        name(key, parent->second);
      }
    for (const auto& circle : relation_cycles(relation)) {
      std::string path;
      for (const auto key : circle)
        if (path.size() < 500) path += "\"" + code_of(key) + "\" is below ";
      const auto sent = std::find_if(circle.begin(), circle.end(),
                                     [&](auto key) { return index_of_.contains(key); });
      if (sent == circle.end()) continue;
      add_problem(index_of_.at(*sent), {ErrorCode::invalid, "Circular hierarchy of terms",
                                        path + "\"" + code_of(circle.front()) + "\".", "parent"});
    }
  }

  std::string code_of(std::int64_t key) const {
    if (const auto sent = index_of_.find(key); sent != index_of_.end())
      return list_.terms[sent->second].code;
    const auto held = now_.find(key);
    return held == now_.end() ? std::to_string(key) : held_text(held->second, "code");
  }

  std::string held_text(const Record& row, const std::string& slug) const {
    const auto column = columns_.find(slug);
    if (column == columns_.end()) return {};
    const auto value = row.values.find(column->second.id);
    return value != row.values.end() && value->second.is_string() ? value->second.get<std::string>()
                                                                  : std::string();
  }

  void add_problem(std::size_t index, const Error& problem) {
    if (problems_.size() < kMaxRowProblems)
      problems_.push_back({keys_.size() > index ? keys_[index] : 0, problem, index});
  }

  PgConnection& connection_;
  OpenTable& open_;
  const TermList& list_;
  TableEdit edit_;
  std::map<std::string, Column> columns_;  // by slug
  std::map<std::int64_t, Record> now_;
  std::map<std::string, std::int64_t> key_of_code_, key_of_uri_;
  std::vector<std::int64_t> keys_;                // keys of the terms
  std::map<std::int64_t, std::size_t> index_of_;  // index of the term of the record
  std::vector<RowError> problems_;
};

// Inserts the table with its terms. If a term cannot be stored, returns the reasons (`problems`).
Result<TableChange> insert_with_terms(PgConnection& connection, Table table, const TermList* terms,
                                      const std::string& user, const std::string& op) {
  auto taken = STRATA_TRY(connection.query(
      "SELECT slug::text FROM record_tables WHERE project_id = $1 AND lower(name) = lower($2)",
      Params().id(table.project_id).text(table.name)));
  if (taken.rows() > 0)
    return fail(ErrorCode::conflict, "Name already used",
                "The project already has a table \"" + table.name + "\" (`" + taken.text(0, 0) +
                    "`). Rename or delete that table first, or use it.",
                "name");
  auto made = STRATA_TRY(insert_table(connection, std::move(table)));
  TableChange change;
  change.table = made;
  if (!terms) return change;
  auto open = STRATA_TRY(read_table(connection, made.id));
  return TermIntake(connection, open, *terms).take(user, op);
}

}  // namespace

Result<std::vector<TableChange>> Tables::create_several(
    const std::vector<NewTable>& tables, bool dry_run, const std::string& user,
    const std::string& op, const IdempotentResponse<std::vector<TableChange>>& answer) {
  STRATA_TRY(check_text(user, "user"));
  std::optional<std::vector<TableChange>> outcome;
  const auto work = [&](PgConnection& connection) -> Result<std::vector<TableChange>> {
    std::vector<TableChange> made;
    bool refused = false;
    for (const NewTable& new_table : tables) {
      Table table = new_table.table;
      STRATA_TRY(check_text(table.name, "name"));
      // The targets are indices of earlier tables, which have ids now.
      for (const auto& [column, place] : new_table.targets)
        table.columns.at(column).target = made.at(place).table.id;
      auto change = STRATA_TRY(insert_with_terms(
          connection, std::move(table), new_table.terms ? &*new_table.terms : nullptr, user, op));
      refused = refused || !change.problems.empty();
      made.push_back(std::move(change));
    }
    if (!refused && !dry_run) return made;
    outcome = std::move(made);
    return fail(ErrorCode::conflict, "Not saved", "Nothing was written.");
  };
  auto done = change(pool_, answer, work, kBulkLimits);
  if (outcome) return std::move(*outcome);
  return done;
}

Result<TableChange> Tables::import_terms(TableId table_id, const TermList& list, bool dry_run,
                                         const std::string& user,
                                         const IdempotentResponse<TableChange>& answer) {
  STRATA_TRY(check_text(user, "user"));
  std::optional<TableChange> outcome;
  const auto work = [&](PgConnection& connection) -> Result<TableChange> {
    auto open = STRATA_TRY(lock_table(connection, table_id));
    if (!term_columns(open.table))
      return fail(ErrorCode::conflict, "Not a term list",
                  open.table.name +
                      " is not a term list. A term list has the columns `code` (a required and "
                      "unique text), `label` (a text) and `parent` (a term of the same table).");
    auto change = TermIntake(connection, open, list).take(user, "import");
    if (!change || (change->problems.empty() && !dry_run)) return change;
    outcome = std::move(*change);
    return fail(ErrorCode::conflict, "Not saved", "Nothing was written.");
  };
  auto done = change(pool_, answer, work, kBulkLimits);
  if (outcome) return std::move(*outcome);
  return done;
}

Result<std::optional<Palette>> term_palette_of(PgConnection& connection, TableId table_id) {
  // Reads only columns that are visible to all roles, because all users who see the layer see its
  // palette.
  auto open = STRATA_TRY(read_table(connection, table_id, least_role(Visibility::everyone)));
  const auto columns = term_columns(open.table);
  if (!columns) return std::optional<Palette>();
  const RecordOrder by_key[] = {{0, false}};
  auto page = STRATA_TRY(load_page(connection, table_id, open.table.columns, {}, {}, Params(),
                                   by_key, {static_cast<std::int64_t>(kMaxTermColors)}));
  return std::optional(terms_palette(list_terms(*columns, page.rows)));
}

}  // namespace strata::store
