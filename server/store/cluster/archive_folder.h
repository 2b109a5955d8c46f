#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "store/cluster/archive_wal.h"
#include "store/cluster/cluster_process.h"

namespace strata::store {

// The archive of a private cluster. It contains base copies of the cluster and the WAL since the
// oldest copy, so that `strata restore` can recover each moment since that copy.
//
//   archive.json       the id of the cluster that owns the archive
//   copies/MOMENT      a complete copy (pg_basebackup), named after the moment of its completion
//   copies/….part      a copy that is being made or deleted, or was interrupted
//   wal/NAME.gz        a WAL segment; NAME.gz.part is being written
class ArchiveFolder {
 public:
  // Opens the archive for the server of `cluster` (the folder `postgres` of the data folder). If
  // the folder is empty, creates an archive. `user` becomes its owner, because PostgreSQL writes
  // it. Returns a `conflict` error if the archive belongs to another cluster, contains other files,
  // or has disappeared, and `invalid` if the archive and the data folder contain each other.
  //
  // A restored cluster has the same system identifier as the original, but writes another WAL. So
  // the archive stores an id of the data folder, which a restore does not copy.
  static Result<ArchiveFolder> claim(const std::filesystem::path& folder,
                                     const std::filesystem::path& cluster,
                                     const DatabaseUser& user);
  // Only reads. Returns a `not_found` error if the folder is not an archive.
  static Result<ArchiveFolder> open(const std::filesystem::path& folder);

  struct Copy {
    std::filesystem::path folder;
    std::chrono::system_clock::time_point made;  // the recovery can end at this moment or later
    WalSegment first;                            // the recovery begins with this segment
  };
  std::vector<Copy> copies() const;       // the complete copies, oldest first
  std::set<WalSegment> segments() const;  // the archived segments

  // The settings of PostgreSQL (`name=value`) for a server that writes to the archive, and for one
  // that recovers from it. Without a moment, the recovery ends with the last archived change.
  std::vector<std::string> archive_settings() const;
  std::vector<std::string> recovery_settings(
      const std::optional<std::chrono::system_clock::time_point>& moment) const;

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path wal() const { return folder_ / "wal"; }
  std::filesystem::path copies_folder() const { return folder_ / "copies"; }

 private:
  ArchiveFolder(std::filesystem::path folder, std::string id)
      : folder_(std::move(folder)), id_(std::move(id)) {}
  std::filesystem::path folder_;  // absolute
  std::string id_;
};

// The name of the folder of a copy that was completed at this moment.
std::string copy_name(std::chrono::system_clock::time_point made);
inline constexpr const char* kUnfinished = ".part";

// Makes the names in a folder durable after a rename.
void sync_folder(const std::filesystem::path& folder);

}  // namespace strata::store
