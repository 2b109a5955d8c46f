#pragma once

#include <memory>
#include <string>
#include <vector>

#include "store/cluster/cluster.h"
#include "store/store.h"

namespace strata::test {

// Returns the private PostgreSQL of the test program. It starts at first use in a temporary folder
// and is removed at the end. If STRATA_TEST_PREPARED names the folder of tests/support/prepare, the
// cluster is a copy of the prepared one, otherwise a new one. Link strata_cluster_support.
store::Cluster& shared_cluster();

// Sends kill -9 to the postmaster and waits until it has ended, so `ensure_running` can notice.
void kill_postmaster(const store::Cluster& cluster);

// Simulates a hanging database: stops the postmaster and all its sessions (kill -STOP) until
// destruction.
class Hang {
 public:
  explicit Hang(const store::Cluster& cluster);
  ~Hang();
  Hang(const Hang&) = delete;
  Hang& operator=(const Hang&) = delete;
  void kill();  // sends kill -9 to all, so none can do any more work

 private:
  const store::Cluster& cluster_;
  std::vector<int> stopped_;
};

// Creates a database of the shared cluster with all migrations, and returns its connection string.
// The database is a copy of a migrated one, because the migrations take longer than most tests.
std::string fresh_database();
// Creates a database without tables, for tests of the migrations themselves.
std::string empty_database();

// Opens a store on a new database.
std::unique_ptr<store::Store> fresh_store(int connections = 4);
std::unique_ptr<store::Store> open_store(const std::string& dsn, int connections = 4);

// A temporary folder that the database user can reach. The destructor removes it. STRATA_TEST_TMP
// replaces the default parent folder /dev/shm (or /tmp).
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
