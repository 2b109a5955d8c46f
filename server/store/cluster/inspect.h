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
  // Programs with this migration, or with a later one, can use the database in its current state,
  // and after an update by this program. 0 if no migration was applied yet.
  std::int64_t readable_from = 0, readable_after_update = 0;
  std::string applied_by;  // version of Strata that last updated the database; may be empty
};
// Returns the version of the newest migration.
Result<std::int64_t> newest_migration(const std::filesystem::path& migrations_dir);

// Returns which version of Strata to start instead, for errors about a newer database. `applied_by`
// is the version that updated it, or empty.
std::string newer_version_advice(const std::string& applied_by);

Result<DatabaseState> inspect_database(const std::string& dsn,
                                       const std::filesystem::path& migrations_dir);

}  // namespace strata::store
