#pragma once

#include <chrono>
#include <functional>

#include "core/error.h"
#include "store/cluster/archive_folder.h"

namespace strata::store {

class Cluster;

// Makes a base copy of the running cluster, and checks it with pg_verifybackup. The copy appears
// only when it is complete. Calls `goes_on` several times a second, and ends with a `cancelled`
// error if it returns false. Returns `storage_full` if the disk is full. The calling thread must
// live until the end, because the kernel ends the programs together with it.
Result<ArchiveFolder::Copy> make_copy(const ArchiveFolder& archive, const Cluster& cluster,
                                      const std::function<bool()>& goes_on);

// Returns whether the archive needs a new copy: it has no copy, the newest is older than `every`,
// or WAL since the newest copy is missing, because PostgreSQL ran without the archive.
Result<bool> needs_copy(const ArchiveFolder& archive, const Cluster& cluster,
                        std::chrono::hours every);

// Deletes copies that were interrupted. No copy may be in progress.
void drop_unfinished(const ArchiveFolder& archive);

// Keeps the newest `keep` copies (at least one) and their WAL, and deletes all other copies and
// WAL.
void drop_old(const ArchiveFolder& archive, int keep);

}  // namespace strata::store
