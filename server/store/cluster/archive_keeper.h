#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/error.h"
#include "store/cluster/archive_folder.h"

namespace strata::store {

class Cluster;

struct ArchiveRules {
  std::chrono::hours copy_every{7 * 24};
  int copies = 4;  // number of copies to keep
};

// The state that PostgreSQL reports for the archive of its WAL.
struct ArchiverState {
  bool archiving = false;                                         // the server has an archive
  std::optional<std::chrono::system_clock::time_point> archived;  // the last archived segment
  std::uint64_t failures = 0;                                     // failed tries
  bool failing = false;                                           // the last try failed
};
Result<ArchiverState> archiver_state(const std::string& dsn);

// Keeps the archive of a running cluster: makes base copies, deletes old ones, and watches the
// archiver of PostgreSQL. It has its own thread. It logs failures and tries again after growing
// pauses. The cluster must outlive it and must have been started with an archive.
class ArchiveKeeper {
 public:
  ArchiveKeeper(const Cluster& cluster, ArchiveRules rules);
  ~ArchiveKeeper();  // ends a copy in progress
  ArchiveKeeper(const ArchiveKeeper&) = delete;
  ArchiveKeeper& operator=(const ArchiveKeeper&) = delete;

  struct Status {
    ArchiverState archiver;
    std::optional<std::chrono::system_clock::time_point> copied;  // the newest complete copy
    std::uint64_t failed_copies = 0;
  };
  Status status() const;  // at most some seconds old; any thread

 private:
  using Clock = std::chrono::steady_clock;
  void keep();
  void watch_archiver();
  Clock::duration keep_copies();  // returns the time until the next call
  bool goes_on() const;

  const Cluster& cluster_;
  const ArchiveFolder archive_;
  const ArchiveRules rules_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  Status status_;
  Clock::duration pause_;  // after the next failure
  std::thread thread_;
};

}  // namespace strata::store
