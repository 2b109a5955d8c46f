#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "store/pg/pg.h"

namespace strata::store {

struct Migration {
  std::string version;  // the digits before the first underscore of the file name: "000001"
  std::string name;     // of the file
  std::string sql;      // between `-- migrate:up` and `-- migrate:down` or the end
  std::string sha256;   // of the whole file, lower-case hex
};

// Returns the *.sql files of a folder in order of version. A file without `-- migrate:up`, or two
// files with the same version, are an Error.
Result<std::vector<Migration>> read_migrations(const std::filesystem::path& folder);

// Applies the missing migrations, each file in one transaction that inserts its version row first,
// under an advisory lock: any number of servers may start at once. Refuses a database that has a
// version not in `known` (it is newer than this program) and one whose applied files differ from
// ours. The file format and the table `schema_migrations` are those of dbmate; the checksums are in
// a separate table, because dbmate has none. Returns the version in force.
Result<std::int64_t> migrate(PgConnection& connection, const std::vector<Migration>& known);

}  // namespace strata::store
