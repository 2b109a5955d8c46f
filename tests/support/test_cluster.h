#pragma once

#include <memory>
#include <string>
#include <vector>

#include "store/cluster/cluster.h"
#include "store/store.h"

namespace strata::test {

// One private PostgreSQL for the test binary, started at first use in a temporary folder and
// removed at the end: a copy of what tests/support/prepare made, where STRATA_TEST_PREPARED names
// it, else a new one. Link strata_cluster_support.
store::Cluster& shared_cluster();

// kill -9 of the postmaster; returns once it is dead, so that `ensure_running` sees it.
void kill_postmaster(const store::Cluster& cluster);

// kill -STOP of the postmaster and all its sessions until the object goes: a database that hangs.
class Hang {
 public:
  explicit Hang(const store::Cluster& cluster);
  ~Hang();
  Hang(const Hang&) = delete;
  Hang& operator=(const Hang&) = delete;
  void kill();  // kill -9 of all: none of them does anything more

 private:
  const store::Cluster& cluster_;
  std::vector<int> stopped_;
};

// A fresh database of the shared cluster, with all migrations: its connection string. It is a copy
// of one that was migrated once, since the migrations take longer than most tests.
std::string fresh_database();
// Without any table, for tests of the migrations themselves.
std::string empty_database();

// A store on a fresh database.
std::unique_ptr<store::Store> fresh_store(int connections = 4);
std::unique_ptr<store::Store> open_store(const std::string& dsn, int connections = 4);

// A temporary folder that the database user can reach; removed with the object. STRATA_TEST_TMP
// names another place than /dev/shm (or /tmp) for it.
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
