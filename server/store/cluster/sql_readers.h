#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"

// The role that analysts use to read with SQL. It has rights on the views of the schema `analysis`
// (db/migrations/000011) and on nothing else.
namespace strata::store {

inline constexpr const char* kReaderRole = "strata_reader";

// Creates or updates the role in the private cluster that `dsn` connects to. The role needs the
// password, has at most ten connections, and can read current and future views. By default, it is
// read-only, a statement may take 30 seconds, and a transaction may be idle for one minute. It
// cannot use temporary tables, large objects or advisory locks, which a new database allows for all
// roles. The password is in the file, which is created (mode 0600) if it does not exist.
Result<void> admit_readers(const std::string& dsn, const std::filesystem::path& password_file);

}  // namespace strata::store
