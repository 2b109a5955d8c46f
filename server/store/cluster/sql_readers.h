#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"

// Analysts who read with SQL: a role with rights on the views of the schema `analysis`
// (db/migrations/000011) and on nothing else.
namespace strata::store {

inline constexpr const char* kReaderRole = "strata_reader";

// Makes the role in the private cluster that `dsn` leads to, or brings it to what it should be: it
// may connect with the password, ten times at once, reads the views of now and of later, and by
// default writes nothing, gives a statement 30 seconds and an idle transaction one minute. What
// anybody may do in a fresh database without leave (temporary tables, large objects, advisory
// locks) it may not. The password stands in the file, which is made (mode 0600) where it is not
// there.
Result<void> admit_readers(const std::string& dsn, const std::filesystem::path& password_file);

}  // namespace strata::store
