#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "core/error.h"

namespace strata::store {

// The facts about a database for a support bundle, and the data that the bundle must not contain.
struct SupportFacts {
  // The server, the schema, its settings and connections; the tables and the indexes with their
  // sizes and their use, but not the content of the tables.
  nlohmann::json server, migrations, tables, indexes;
  std::vector<std::string> people;   // user names and full names, also of deleted users
  std::vector<std::string> secrets;  // stored as they are: links for phones, hashes of passwords
  std::unordered_set<std::string> secret_hashes;  // SHA-256, 32 bytes, of tokens and links
};

// Only reads.
Result<SupportFacts> support_facts(const std::string& dsn,
                                   const std::filesystem::path& migrations_dir);

// Returns the passwords in a libpq connection string, and the same string without them. For a
// string that libpq cannot read, `text` is empty.
struct PublicDsn {
  std::string text;
  std::vector<std::string> passwords;
};
PublicDsn without_passwords(const std::string& dsn);

}  // namespace strata::store
