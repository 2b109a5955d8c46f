#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"

namespace strata::cli {

struct ArchiveRestore {
  std::filesystem::path archive;
  std::filesystem::path data;  // unused with `check_only`
  std::string at;              // ISO 8601; empty: the last archived change
  bool check_only = false;     // restore into a temporary folder, and delete it
};
// Restores a moment from an archive, and reports the result. Returns the exit code.
int restore_from_archive(const ArchiveRestore& options);

// Returns an error if the folder contains anything other than an interrupted restore.
Result<void> check_new_data_folder(const std::filesystem::path& data);
// The folder in a data folder to which a restore writes. The result is then renamed, so an
// interrupted restore never leaves an incomplete database that a server could start with.
inline constexpr const char* kRestoring = "restoring";
// Moves the restored database to the folder `postgres` of the data folder.
Result<void> finish_restore(const std::filesystem::path& data);

}  // namespace strata::cli
