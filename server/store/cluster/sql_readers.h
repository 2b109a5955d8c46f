#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"

// Analysts read with SQL as a role with rights on the views of the schema `analysis`
// (db/migrations/000011) and on nothing else.
namespace strata::store {

inline constexpr const char* kReaderRole = "strata_reader";

// Makes or updates the role in the private cluster that `dsn` connects to. The role may connect
// with the password, ten times at once, and reads present and future views. By default it writes
// nothing, and has 30 seconds for a statement and one minute for an idle transaction. It may not
// use temporary tables, large objects or advisory locks, which a fresh database allows to
// everybody. The password is in the file, which is created (mode 0600) if it does not exist.
Result<void> admit_readers(const std::string& dsn, const std::filesystem::path& password_file);

}  // namespace strata::store
