#pragma once

#include <span>
#include <vector>

#include "store/journal/journal.h"
#include "store/pg/pg.h"

namespace strata::store {

struct CommitFailure {
  Error problem;
  bool transient;  // trying the same again may succeed: the connection, the disk, a deadlock
};

// Writes the entries in one transaction: the journal rows, what they enable and disable, their tile
// revisions and the sequences of model and layers. An entry must follow the model's last one:
// another sequence is a failure (conflict), so that an edit made on top of one that was not saved
// can never be kept.
tl::expected<void, CommitFailure> commit_entries(PgConnection& connection,
                                                 std::span<const JournalEntry* const> entries);

// Which of the entries are in the journal already, with the same sequence and id.
Result<std::vector<bool>> find_saved(PgConnection& connection,
                                     std::span<const JournalEntry* const> entries);

}  // namespace strata::store
