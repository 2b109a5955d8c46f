#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "domain/tables/cell_history.h"
#include "domain/tables/table.h"

namespace strata::store {

inline constexpr std::int64_t kMaxRecords = 1'000'000;     // of a table
inline constexpr std::size_t kMaxRecordsAtOnce = 100'000;  // of a call
inline constexpr std::size_t kMaxRowProblems = 100;        // that are returned
inline constexpr std::size_t kMaxUniqueTextLength = 1000;  // bytes: the limit of an index

// The requested values of one record.
struct RecordInput {
  std::optional<std::int64_t> key;  // none: a new record with the next key
  // by column id; a new record gets the defaults for missing columns
  std::map<ColumnId, nlohmann::json> values;
  std::optional<std::int64_t> version{};  // of the record as it was read: otherwise it is stale
};
struct WriteRecords {
  std::vector<RecordInput> records;
  bool may_create = true;  // records of unused keys
  bool may_change = true;  // existing records
  bool dry_run = false;    // check everything, write nothing
  std::string op = "records";
};

// The reason why one of the records cannot be written.
struct RowError {
  std::int64_t key = 0;
  Error problem;
  std::optional<std::size_t> index;  // its place in WriteRecords
};

// The result of a change of a table.
struct TableChange {
  Table table;                // as it is now
  std::int64_t sequence = 0;  // of the entry in its journal; 0: no change
  bool columns_changed = false;
  std::vector<std::int64_t> created, changed, deleted;  // keys, ascending
  std::vector<Record> records;                          // the created or changed ones, by key
  nlohmann::json record;                                // the change, as stored in the journal
  std::vector<RowError> problems;                       // not empty: nothing was written
};

// The effect of an undo or redo before it is made, so that a caller can first check which records
// are painted.
struct UndoPlan {
  std::int64_t table_sequence = 0;      // at the time of the plan
  std::int64_t edit = 0;                // the entry that is undone or redone
  std::vector<std::int64_t> vanishing;  // records that would be deleted
};

// A row of a table's journal, newest first.
struct TableEditRow {
  std::int64_t sequence = 0;
  std::string user, op;
  nlohmann::json record;
  std::chrono::system_clock::time_point time;
  bool in_force = true;
  struct Change {
    bool is_column = false;
    std::int64_t id = 0;  // key or column
    Cells before, after;
  };
  std::vector<Change> changes;  // the first kMaxListedChanges of them
  std::int64_t total_changes = 0;
};
inline constexpr int kMaxListedChanges = 100;

}  // namespace strata::store
