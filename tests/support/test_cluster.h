#pragma once

#include <memory>
#include <string>
#include <vector>

#include "store/cluster/cluster.h"
#include "store/store.h"

namespace strata::test {

// One private PostgreSQL for the test program, started at first use in a temporary folder and
// removed at the end: a copy of the result of tests/support/prepare if STRATA_TEST_PREPARED names
// it, otherwise a new one. Link strata_cluster_support.
store::Cluster& shared_cluster();

// Sends kill -9 to the postmaster; returns when it has ended, so that `ensure_running` notices.
void kill_postmaster(const store::Cluster& cluster);

// Sends kill -STOP to the postmaster and all its sessions until destruction: a hanging database.
class Hang {
 public:
  explicit Hang(const store::Cluster& cluster);
  ~Hang();
  Hang(const Hang&) = delete;
  Hang& operator=(const Hang&) = delete;
  void kill();  // sends kill -9 to all: none can do any more work

 private:
  const store::Cluster& cluster_;
  std::vector<int> stopped_;
};

// Creates a database of the shared cluster with all migrations, and returns its connection string.
// It is a copy of a migrated one, because the migrations take longer than most tests.
std::string fresh_database();
// Without any table, for tests of the migrations themselves.
std::string empty_database();

// Opens a store on a new database.
std::unique_ptr<store::Store> fresh_store(int connections = 4);
std::unique_ptr<store::Store> open_store(const std::string& dsn, int connections = 4);

// A temporary folder that the database user can reach; the destructor removes it. STRATA_TEST_TMP
// names a folder other than /dev/shm (or /tmp) for it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace strata::test
