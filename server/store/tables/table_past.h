#pragma once

#include <optional>

#include "core/ids.h"
#include "store/store.h"
#include "store/tables/table_writer.h"
#include "store/tables/tables.h"

// Past states of a table, and the computation of undo.
namespace strata::store {

// Returns the records after a sequence, by key. `open` gets the columns of that time.
Result<std::vector<Record>> rows_at(PgConnection& connection, OpenTable& open,
                                    std::int64_t sequence);

Result<TableHistory> read_history(PgConnection& connection, TableId table_id, Role seen_by,
                                  std::optional<std::int64_t> key, int limit, int offset,
                                  std::optional<std::int64_t> before);

struct PlannedUndo {
  UndoPlan plan;
  TableEdit edit;
};
// Plans an undo or redo by the rule of domain/tables/cell_history. With `entry`, plans to undo this
// entry of the user instead of the newest one. Returns a `conflict` error if the user has nothing
// to undo or redo.
Result<PlannedUndo> plan_undo(PgConnection& connection, const OpenTable& open,
                              const std::string& user, bool redo,
                              std::optional<std::int64_t> entry = {});

}  // namespace strata::store
