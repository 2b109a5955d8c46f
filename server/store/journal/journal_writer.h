#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/histogram.h"
#include "store/journal/journal.h"
#include "store/pg/pg_limits.h"

namespace strata::store {

class Store;

// Makes edits durable, on its own thread and with a separate connection (synchronous_commit on).
// Entries are committed in the given order, and waiting entries are grouped into one transaction.
// After a failed commit, the writer reconnects and tries again, in order, until `retry_for` has
// passed since the first attempt began. An entry whose id is already in the journal with the same
// sequence is considered saved, because an attempt may have committed before its response was lost.
// After `retry_for`, every waiting entry gets the error, in order, and the writer continues with
// later entries. A database that hangs is considered unreachable: an attempt ends if no byte was
// transferred for `limits.answer`.
class JournalWriter {
 public:
  struct Options {
    std::chrono::milliseconds retry_for{30'000};
    std::size_t max_waiting_bytes = 256u << 20;
    PgLimits limits{std::chrono::seconds(10), std::chrono::seconds(0), std::chrono::seconds(5)};
  };
  using Done = std::function<void(Result<void>)>;  // called on the thread of the writer, in order

  JournalWriter(Store& store, Options options);
  ~JournalWriter();  // writes the waiting entries, then joins the thread

  // Returns false if the queue is full or commits fail. The caller must then refuse new edits.
  // `accepting()` returns the same in advance.
  bool submit(JournalEntry entry, Done done);
  bool accepting() const;
  // For the metrics of the server: entries without a result, the times of successful transactions,
  // and the number of failed ones.
  std::size_t waiting() const;
  const Histogram& commit_times() const;
  std::uint64_t failed_commits() const;
  void drain();  // waits until all earlier entries are done and new entries are accepted

  // Sets an earlier time for the objects that were made in a project since `since`: comments,
  // records, files, views, tours, kiosk links, and the activity about them. Edits have the times of
  // their entries. Only the demo uses it, because its history is invented. Returns the current time
  // of the database, for the next `since`. Blocks.
  static Result<std::chrono::system_clock::time_point> date_back(
      Store& store, ProjectId project, std::chrono::system_clock::time_point since,
      std::chrono::system_clock::time_point time);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
