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

// A table to create, with its terms if it is a term list. The terms are the first entry in the
// journal of the table.
struct NewTable {
  Table table;
  // for columns that refer to an earlier table of the list: index of the column → index of the
  // table
  std::map<std::size_t, std::size_t> targets{};
  std::optional<TermList> terms{};
};

struct TableHistory {
  std::vector<TableEditRow> rows;
  std::int64_t total = 0;
};

// Tables of a project with their columns, by id or slug. Changes to columns and records are entries
// in the journal of the table, each by one user. Results contain only the columns that the role
// sees. They contain no names and no past states of other columns. Only a TableChange has all
// columns. Part of Store, whose rules for threads and errors apply.
class Tables {
 public:
  explicit Tables(Pool& pool) : pool_(pool) {}

  Result<std::vector<Table>> of_project(ProjectId project_id, Role seen_by);  // sorted by name
  Result<Table> find(const std::string& ref, Role seen_by);
  // creates the table with its columns
  Result<Table> create(const Table& table, const IdempotentResponse<Table>& answer = {});
  // changes name, labels and description
  Result<Table> update(const Table& table, const IdempotentResponse<Table>& answer = {});
  // returns a `conflict` error while another object refers to the table
  Result<void> remove(TableId id, const IdempotentResponse<>& answer = {});
  // Creates all tables or none: if one of the changes has problems, no table was created. Returns a
  // `conflict` error if the project has a table of the same name.
  Result<std::vector<TableChange>> create_several(
      const std::vector<NewTable>& tables, bool dry_run, const std::string& user,
      const std::string& op, const IdempotentResponse<std::vector<TableChange>>& answer = {});
  // Imports all terms or none into a term list, as one entry of its journal. Returns a `conflict`
  // error if the table is not a term list. A term whose URI or code exists changes the existing
  // record; other terms are new. Properties that the imported text does not contain stay unchanged.
  // Problems name the term by its index.
  Result<TableChange> import_terms(TableId table_id, const TermList& list, bool dry_run,
                                   const std::string& user,
                                   const IdempotentResponse<TableChange>& answer = {});
  Result<TableChange> create_column(TableId table_id, const Column& column, const std::string& user,
                                    const IdempotentResponse<TableChange>& answer = {});
  // If the kind or target changes, a new column replaces the old one and takes the values that it
  // can store. `record` of the change contains the counts (`converted`, `lost`, `lost_keys`).
  Result<TableChange> update_column(TableId table_id, const Column& column,
                                    std::optional<std::int64_t> version, const std::string& user,
                                    const IdempotentResponse<TableChange>& answer = {});
  // Sets the visibility of the column, now and in the past, if `version` is the current version.
  // The change is not an entry of the journal, so undo cannot make a column visible again. Returns
  // an `invalid` error for a column that a term list needs, and for a required column that users
  // who write records would not see.
  Result<Table> show_column(TableId table_id, ColumnId column_id, Visibility visibility,
                            std::int64_t version, const IdempotentResponse<Table>& answer = {});
  Result<TableChange> drop_column(TableId table_id, ColumnId column_id,
                                  std::optional<std::int64_t> version, const std::string& user,
                                  const IdempotentResponse<TableChange>& answer = {});
  // Returns the sequence of the last change up to a time, like Journal::sequence_at.
  Result<std::int64_t> sequence_at(TableId table_id, const std::string& utc);
  // Returns the sequence of the last change up to the time of an edit of a model.
  Result<std::int64_t> sequence_when(TableId table_id, ModelId model_id, std::int64_t sequence);
  // Returns the entries of the journal, newest first. Leaves out changes to cells that the role
  // does not see, and their descriptions in the entries. `before` selects only entries with lower
  // sequences.
  Result<TableHistory> history(TableId table_id, Role seen_by, std::optional<std::int64_t> key,
                               int limit, int offset, std::optional<std::int64_t> before = {});
  // Returns the change of an entry of the journal, with the current state of the table and of the
  // records. `created` contains only records that still exist. If it changed the columns, or more
  // than `most_records` records, `records` is empty. Returns `not_found` if the table or the entry
  // does not exist.
  Result<TableChange> change_of(TableId table_id, std::int64_t sequence, std::size_t most_records);
  // Plans to undo the newest entry of the user in force, or to redo the entry that was undone last.
  // Returns a `conflict` error if no such entry exists. `undo` returns a `stale` error if the table
  // has changed since the plan.
  Result<UndoPlan> plan_undo(TableId table_id, const std::string& user, bool redo);
  Result<TableChange> undo(TableId table_id, const std::string& user, bool redo,
                           std::int64_t planned_at,
                           const IdempotentResponse<TableChange>& answer = {});
  // Undoes this entry of the user, also if the user or others have changed other parts of the table
  // since. The user cannot redo it. Returns a `conflict` error if the entry is not in force, or if
  // one of its records was changed since. The caller must check that no texel has the key of a
  // record that the undo deletes.
  Result<TableChange> undo_entry(TableId table_id, std::int64_t sequence, const std::string& user);

 private:
  Pool& pool_;
};

}  // namespace strata::store
