#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/error.h"

namespace strata::store {

// What a database holds, without changing it.
struct DatabaseState {
  std::string server_version, encoding;
  std::int64_t schema_version = 0;  // 0: no migration was applied yet
  std::int64_t known_version = 0;   // of the newest migration here
  std::uint64_t bytes = 0;
};
// The newest version of the schema that there is a migration to.
Result<std::int64_t> newest_migration(const std::filesystem::path& migrations_dir);

Result<DatabaseState> inspect_database(const std::string& dsn,
                                       const std::filesystem::path& migrations_dir);

}  // namespace strata::store
