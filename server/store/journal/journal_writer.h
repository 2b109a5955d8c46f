#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/error.h"
#include "store/journal/journal.h"
#include "store/pg/pg_limits.h"

namespace strata::store {

class Store;

// The thread that makes edits durable, with a connection of its own (synchronous_commit on).
// Entries commit in the order given; what waits is grouped into one transaction. A failed commit is
// retried in order until `retry_for` has passed since its first try began (reconnecting each time;
// an entry whose id is already in the journal with the same sequence counts as saved, since the
// first try may have committed before the answer was lost). Then every waiting entry is answered
// with the Error, in order, and the writer starts anew with what comes later. A database that
// hangs fails as one that is away does: no try lasts longer than `limits.answer` without a byte
// moving.
class JournalWriter {
 public:
  struct Options {
    std::chrono::milliseconds retry_for{30'000};
    std::size_t max_waiting_bytes = 256u << 20;
    PgLimits limits{std::chrono::seconds(10), std::chrono::seconds(0), std::chrono::seconds(5)};
  };
  using Done = std::function<void(Result<void>)>;  // called on the writer's thread, in order

  JournalWriter(Store& store, Options options);
  ~JournalWriter();  // writes what waits, then joins

  // False when the queue is full or failing: the caller refuses new edits (`accepting()` tells
  // beforehand).
  bool submit(JournalEntry entry, Done done);
  bool accepting() const;
  void drain();  // waits until everything submitted before is answered, and new entries are taken

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
