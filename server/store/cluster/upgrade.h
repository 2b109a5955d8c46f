#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "core/error.h"
#include "core/progress.h"
#include "store/cluster/backup.h"

// Upgrades a private cluster to a newer major version of PostgreSQL. The new cluster is made in the
// folder `upgrading` of the data folder and compared with the old one. Then two renames replace the
// old cluster by the new one. Before the renames, and after every failure, the site is unchanged.
namespace strata::store {

struct UpgradePlan {
  enum class Method {
    clone,  // pg_upgrade, the file system shares the blocks of the files
    copy,   // pg_upgrade copies the files
    dump,   // pg_dump and pg_restore
  };
  std::filesystem::path data;  // the data folder, absolute
  int from = 0, to = 0;        // major versions; equal if there is nothing to do
  std::filesystem::path old_programs, new_programs;
  Method method = Method::dump;
  bool running = false;            // a server has the data open, so only a rehearsal is possible
  bool archived = false;           // the old cluster has an archive, which the new one cannot use
  std::filesystem::path fallback;  // the name of the old cluster after the upgrade
  std::uintmax_t bytes = 0;        // size of the old cluster
  std::uintmax_t free_bytes = 0;   // free space of its disk

  std::filesystem::path cluster() const { return data / "postgres"; }
  std::filesystem::path work() const { return data / "upgrading"; }
  // The free space that the upgrade needs. A rehearsal while a server is running may also need a
  // copy of the old cluster.
  std::uintmax_t needed_bytes(bool rehearse) const;
};

// Changes nothing. Chooses pg_upgrade if both versions have the programs for it, unless `dump`.
// Returns `not_found` if there is no database, `forbidden` if the data belong to another user,
// `conflict` if there is already an old cluster of that name, and `internal` if programs of one of
// the versions are missing.
Result<UpgradePlan> plan_upgrade(const std::filesystem::path& data_dir, bool dump);

struct UpgradeReport {
  BackupFacts facts;  // the content of the old cluster, and of the new one
  std::chrono::seconds took{0};
};
// Does everything except the renames, and deletes the new cluster. If a server is running, it keeps
// running, and the rehearsal uses a copy of its cluster (pg_basebackup).
Result<UpgradeReport> rehearse_upgrade(const UpgradePlan& plan, Progress& progress);
// Makes the new cluster and replaces the old one. Returns `conflict` if a server is running.
Result<UpgradeReport> upgrade_cluster(const UpgradePlan& plan, Progress& progress);

}  // namespace strata::store
