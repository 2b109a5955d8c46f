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

inline constexpr std::int64_t kMaxRecords = 1'000'000;     // per table
inline constexpr std::size_t kMaxRecordsAtOnce = 100'000;  // per call
inline constexpr std::size_t kMaxRowProblems = 100;        // per result of a call
// bytes, because the size of an index entry is limited
inline constexpr std::size_t kMaxUniqueTextLength = 1000;

// The requested values of one record.
struct RecordInput {
  std::optional<std::int64_t> key;  // nothing for a new record, which gets the next key
  // values by column id; in a new record, missing columns get their defaults
  std::map<ColumnId, nlohmann::json> values;
  // version of the record when it was read; another version is `stale`
  std::optional<std::int64_t> version{};
};
struct WriteRecords {
  std::vector<RecordInput> records;
  bool may_create = true;  // records with unused keys
  bool may_change = true;  // existing records
  bool dry_run = false;    // check everything, write nothing
  std::string op = "records";
};

// The reason why one of the records cannot be written.
struct RowError {
  std::int64_t key = 0;
  Error problem;
  std::optional<std::size_t> index;  // index in WriteRecords
};

// The result of a change to a table.
struct TableChange {
  Table table;                // the current state of the table
  std::int64_t sequence = 0;  // sequence of the entry in its journal; 0 if nothing changed
  bool columns_changed = false;
  std::vector<std::int64_t> created, changed, deleted;  // keys, ascending
  std::vector<Record> records;                          // the created or changed records, by key
  nlohmann::json record;                                // the change, as stored in the journal
  std::vector<RowError> problems;                       // if there are any, nothing was written
};

// The effect of an undo or redo before it is applied, so that a caller can first check which
// records are painted.
struct UndoPlan {
  std::int64_t table_sequence = 0;      // sequence of the table at the time of the plan
  std::int64_t edit = 0;                // the entry that is undone or redone
  std::vector<std::int64_t> vanishing;  // records that the undo or redo deletes
};

// A row of the journal of a table, which is sorted newest first.
struct TableEditRow {
  std::int64_t sequence = 0;
  std::string user, op;
  nlohmann::json record;
  std::chrono::system_clock::time_point time;
  bool in_force = true;
  struct Change {
    bool is_column = false;
    std::int64_t id = 0;  // key of the record, or id of the column
    Cells before, after;
  };
  std::vector<Change> changes;  // the first kMaxListedChanges changes
  std::int64_t total_changes = 0;
};
inline constexpr int kMaxListedChanges = 100;

}  // namespace strata::store
