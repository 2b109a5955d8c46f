#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/tables/table.h"
#include "domain/tables/term.h"
#include "store/content/idempotent_response.h"
#include "store/tables/table_changes.h"

namespace strata::store {

class Pool;

// Several tables and the terms of term lists among them, all or none: if one of the changes has
// problems, nothing was made. conflict: the project has a table of that name. Terms are the first
// entry of their table's journal.
struct NewTable {
  Table table;
  // of columns that name one of the tables before it: column → table, by their places
  std::map<std::size_t, std::size_t> targets{};
  std::optional<TermList> terms{};
};

struct TableHistory {
  std::vector<TableEditRow> rows;
  std::int64_t total = 0;
};

// Tables of a project with their columns, by id or slug. Changes of columns and records are entries
// of the table's journal, each by one user. Results contain the columns that the role sees; other
// columns do not appear, neither by name nor in the past. A TableChange has all columns. Part of
// Store: its rules for threads and errors hold.
class Tables {
 public:
  explicit Tables(Pool& pool) : pool_(pool) {}

  Result<std::vector<Table>> of_project(ProjectId project_id, Role seen_by);  // by name
  Result<Table> find(const std::string& ref, Role seen_by);
  // with its columns
  Result<Table> create(const Table& table, const IdempotentResponse<Table>& answer = {});
  // name, labels, description
  Result<Table> update(const Table& table, const IdempotentResponse<Table>& answer = {});
  // refused (conflict) while another object names it
  Result<void> remove(TableId id, const IdempotentResponse<>& answer = {});
  Result<std::vector<TableChange>> create_several(
      const std::vector<NewTable>& tables, bool dry_run, const std::string& user,
      const std::string& op, const IdempotentResponse<std::vector<TableChange>>& answer = {});
  // Imports terms into a term list (conflict: the table is not one) as one entry of its journal:
  // terms whose URI or code exists change that record, the others are new, and properties that the
  // text lacks stay. All or none; problems name the term by its place.
  Result<TableChange> import_terms(TableId table_id, const TermList& list, bool dry_run,
                                   const std::string& user,
                                   const IdempotentResponse<TableChange>& answer = {});
  // If the kind or target changes, a new column replaces the old one and takes the values that it
  // can hold: `record` of the change contains the counts (`converted`, `lost`, `lost_keys`).
  Result<TableChange> create_column(TableId table_id, const Column& column, const std::string& user,
                                    const IdempotentResponse<TableChange>& answer = {});
  Result<TableChange> update_column(TableId table_id, const Column& column,
                                    std::optional<std::int64_t> version, const std::string& user,
                                    const IdempotentResponse<TableChange>& answer = {});
  // Sets the visibility of the column, now and in the past: this is no entry of the journal, so
  // that undo makes nothing visible again. If version equals. Refused (invalid): a column that a
  // term list needs, or a required column that users who write records would not see.
  Result<Table> show_column(TableId table_id, ColumnId column_id, Visibility visibility,
                            std::int64_t version, const IdempotentResponse<Table>& answer = {});
  Result<TableChange> drop_column(TableId table_id, ColumnId column_id,
                                  std::optional<std::int64_t> version, const std::string& user,
                                  const IdempotentResponse<TableChange>& answer = {});
  // Returns the sequence of the last change until a time, as `sequence_at`.
  Result<std::int64_t> sequence_at(TableId table_id, const std::string& utc);
  // The same until an edit of a model was made.
  Result<std::int64_t> sequence_when(TableId table_id, ModelId model_id, std::int64_t sequence);
  // Leaves out changes of cells that the role does not see, and their descriptions in the entries.
  // Newest first; `before`: only those with lower sequences.
  Result<TableHistory> history(TableId table_id, Role seen_by, std::optional<std::int64_t> key,
                               int limit, int offset, std::optional<std::int64_t> before = {});
  // Plans to undo the user's newest entry in force, or to redo the one that was undone last;
  // `conflict` if no such entry exists. Undo is refused (stale) if the table changed since the
  // plan.
  Result<UndoPlan> plan_undo(TableId table_id, const std::string& user, bool redo);
  Result<TableChange> undo(TableId table_id, const std::string& user, bool redo,
                           std::int64_t planned_at,
                           const IdempotentResponse<TableChange>& answer = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
