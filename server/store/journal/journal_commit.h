#pragma once

#include <span>
#include <vector>

#include "store/journal/journal.h"
#include "store/pg/pg.h"

namespace strata::store {

struct CommitFailure {
  Error problem;
  bool transient;  // a retry may succeed: the connection, the disk, a deadlock
};

// Writes the entries in one transaction: the journal rows, the edits that they enable and disable,
// their tile revisions and the sequences of model and layers. An entry must follow the model's last
// entry: another sequence is a failure (conflict), so that an edit on top of an unsaved edit can
// never be stored.
tl::expected<void, CommitFailure> commit_entries(PgConnection& connection,
                                                 std::span<const JournalEntry* const> entries);

// Returns, for each entry, whether the journal contains it already with the same sequence and id.
Result<std::vector<bool>> find_saved(PgConnection& connection,
                                     std::span<const JournalEntry* const> entries);

}  // namespace strata::store
