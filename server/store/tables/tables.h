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

// Several tables and the terms of those that are lists, all or none: where one of the changes has
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

// Tables of a project with their columns, by id or slug. Changes of columns and records are
// entries of the table's journal, of one person each. With the columns that the role sees: to it
// the others are not there, neither by name nor in the past. A TableChange has all. Part of Store:
// its rules for threads and errors hold.
class Tables {
 public:
  explicit Tables(Pool& pool) : pool_(pool) {}

  // table's journal, of one person each. With the columns that the role sees: to it the others are
  // not there, neither by name nor in the past. A TableChange has all.
  Result<std::vector<Table>> of_project(ProjectId project_id, Role seen_by);  // by name
  Result<Table> find(const std::string& ref, Role seen_by);
  // with its columns
  Result<Table> create(const Table& table, const IdempotentResponse<Table>& answer = {});
  // name, labels, description
  Result<Table> update(const Table& table, const IdempotentResponse<Table>& answer = {});
  // refused (conflict) while something names it
  Result<void> remove(TableId id, const IdempotentResponse<>& answer = {});
  Result<std::vector<TableChange>> create_several(
      const std::vector<NewTable>& tables, bool dry_run, const std::string& user,
      const std::string& op, const IdempotentResponse<std::vector<TableChange>>& answer = {});
  // Terms come into a list (conflict: the table is none) as one entry of its journal: those whose
  // URI or code is there change that record, the others are new, and what the text does not have
  // stays. All or none; problems name the term by its place.
  Result<TableChange> import_terms(TableId table_id, const TermList& list, bool dry_run,
                                   const std::string& user,
                                   const IdempotentResponse<TableChange>& answer = {});
  // Where the kind or target changes, the column makes way for a new one that takes over what it
  // can hold: `record` of the change says how much that was (`converted`, `lost`, `lost_keys`).
  Result<TableChange> create_column(TableId table_id, const Column& column, const std::string& user,
                                    const IdempotentResponse<TableChange>& answer = {});
  Result<TableChange> update_column(TableId table_id, const Column& column,
                                    std::optional<std::int64_t> version, const std::string& user,
                                    const IdempotentResponse<TableChange>& answer = {});
  // Who sees the column, now and in the past: no entry of the journal, so that nothing is seen
  // again by undo. Where version equals. Refused (invalid): a list of terms lives by the column, or
  // who writes records would not see it and must fill it.
  Result<Table> show_column(TableId table_id, ColumnId column_id, Visibility visibility,
                            std::int64_t version, const IdempotentResponse<Table>& answer = {});
  Result<TableChange> drop_column(TableId table_id, ColumnId column_id,
                                  std::optional<std::int64_t> version, const std::string& user,
                                  const IdempotentResponse<TableChange>& answer = {});
  // Of the last change until a time, as `sequence_at`.
  Result<std::int64_t> sequence_at(TableId table_id, const std::string& utc);
  // The same until an edit of a model was made.
  Result<std::int64_t> sequence_when(TableId table_id, ModelId model_id, std::int64_t sequence);
  // What was done to cells that the role does not see is left out, and what the entries say of
  // themselves with it. The newest first; `before`: only those with lower sequences.
  Result<TableHistory> history(TableId table_id, Role seen_by, std::optional<std::int64_t> key,
                               int limit, int offset, std::optional<std::int64_t> before = {});
  // The person's newest entry in force, or the one that was undone last; `conflict` where there is
  // none. Done where the table is as it was when it was planned (stale).
  Result<UndoPlan> plan_undo(TableId table_id, const std::string& user, bool redo);
  Result<TableChange> undo(TableId table_id, const std::string& user, bool redo,
                           std::int64_t planned_at,
                           const IdempotentResponse<TableChange>& answer = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
