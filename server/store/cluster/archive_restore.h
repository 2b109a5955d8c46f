#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/error.h"
#include "core/progress.h"
#include "store/cluster/archive_folder.h"
#include "store/cluster/archive_wal.h"

namespace strata::store {

// A plan to recover the state at a moment from an archive.
struct RestorePlan {
  ArchiveFolder::Copy copy;
  std::optional<std::chrono::system_clock::time_point> moment;  // empty: the last archived change
  std::optional<WalSegment> newest;  // the last archived segment; empty: none since the copy
};
// Chooses the newest copy before the moment. Returns `not_found` if the archive has no such copy.
// Returns `invalid` if the moment is in the future. Without a moment, also returns `invalid` if a
// WAL segment between the copy and the newest segment is missing.
Result<RestorePlan> plan_restore(
    const ArchiveFolder& archive,
    const std::optional<std::chrono::system_clock::time_point>& moment);

// The content of a recovered database.
struct RestoredSite {
  std::chrono::system_clock::time_point reached;  // time of the last change
  std::int64_t projects = 0, models = 0, edits = 0;
  std::optional<std::chrono::system_clock::time_point> last_edit;
};
// Recovers the moment into `data_dir`/postgres, which must not exist, and stops PostgreSQL again.
// The copy is checked against its manifest. Returns `invalid` if the moment is after the last
// archived change, or if the archive is damaged. Without a moment, all archived segments must have
// been replayed. After an error, the folder is incomplete.
Result<RestoredSite> restore_archive(const ArchiveFolder& archive, const RestorePlan& plan,
                                     const std::filesystem::path& data_dir, Progress& progress);

}  // namespace strata::store
