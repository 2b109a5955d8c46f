#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/error.h"

namespace strata::store {

// The state of a database. `inspect_database` does not change anything.
struct DatabaseState {
  std::string server_version, encoding;
  std::int64_t schema_version = 0;  // 0 if no migration was applied yet
  std::int64_t known_version = 0;   // version of the newest migration in the folder
  std::uint64_t bytes = 0;
};
// Returns the version of the newest migration.
Result<std::int64_t> newest_migration(const std::filesystem::path& migrations_dir);

Result<DatabaseState> inspect_database(const std::string& dsn,
                                       const std::filesystem::path& migrations_dir);

}  // namespace strata::store
