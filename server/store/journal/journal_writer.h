#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/error.h"
#include "store/journal/journal.h"
#include "store/pg/pg_limits.h"

namespace strata::store {

class Store;

// The thread that makes edits durable, with a separate connection (synchronous_commit on). Entries
// commit in the given order; waiting entries are grouped into one transaction. A failed commit is
// retried in order until `retry_for` has passed since its first attempt began (reconnecting each
// time; an entry whose id is already in the journal with the same sequence counts as saved, since
// the first attempt may have committed before the answer was lost). Then every waiting entry is
// answered with the Error, in order, and the writer continues with later entries. A database that
// hangs fails like one that is unreachable: no attempt lasts longer than `limits.answer` without a
// byte transferred.
class JournalWriter {
 public:
  struct Options {
    std::chrono::milliseconds retry_for{30'000};
    std::size_t max_waiting_bytes = 256u << 20;
    PgLimits limits{std::chrono::seconds(10), std::chrono::seconds(0), std::chrono::seconds(5)};
  };
  using Done = std::function<void(Result<void>)>;  // called on the writer's thread, in order

  JournalWriter(Store& store, Options options);
  ~JournalWriter();  // writes the waiting entries, then joins

  // Returns false when the queue is full or failing: the caller refuses new edits (`accepting()`
  // returns the same in advance).
  bool submit(JournalEntry entry, Done done);
  bool accepting() const;
  void drain();  // waits until all earlier entries are answered and new ones are accepted

  // Gives what was made in a project since `since` an earlier time: comments, records, files,
  // views, tours, kiosk links, and the activity about them. Edits have the times of their entries.
  // For the demo, whose story is made up. Returns the database's present time, for the next
  // `since`. Blocks.
  static Result<std::chrono::system_clock::time_point> date_back(
      Store& store, ProjectId project, std::chrono::system_clock::time_point since,
      std::chrono::system_clock::time_point time);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
