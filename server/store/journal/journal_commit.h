#pragma once

#include <span>
#include <vector>

#include "store/journal/journal.h"
#include "store/pg/pg.h"

namespace strata::store {

struct CommitFailure {
  Error problem;
  // true if a retry may succeed, as after a failure of the connection or the disk, or a deadlock
  bool transient;
};

// Writes the entries in one transaction: the journal rows, the edits that they enable and disable,
// their tile revisions, and the sequences of model and layers. An entry must follow the last entry
// of the model. Another sequence is a `conflict`, so an edit that depends on an unsaved edit can
// never be stored. If another server has claimed the model since the epoch of an entry, nothing is
// written, and the error is `moved`, with the address of the owner.
tl::expected<void, CommitFailure> commit_entries(PgConnection& connection,
                                                 std::span<const JournalEntry* const> entries);

// Returns, for each entry, whether the journal already contains it with the same sequence and id.
Result<std::vector<bool>> find_saved(PgConnection& connection,
                                     std::span<const JournalEntry* const> entries);

}  // namespace strata::store
