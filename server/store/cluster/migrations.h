#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "store/pg/pg.h"

namespace strata::store {

struct Migration {
  std::string version;  // the digits before the first underscore of the file name: "000001"
  std::string name;     // name of the file
  std::string sql;      // text between `-- migrate:up` and `-- migrate:down` or the end
  std::string sha256;   // hash of the whole file, lower-case hex
};

// Returns the *.sql files of a folder in order of version. Returns an error for a file without `--
// migrate:up`, and for two files with the same version.
Result<std::vector<Migration>> read_migrations(const std::filesystem::path& folder);

// Applies the missing migrations. Each file is one transaction, which inserts its version row
// first. An advisory lock allows any number of servers to start at the same time. Returns an error
// if the database has a version that is not in `known`, because it is then newer than this program,
// or if an applied file differs from `known`. The file format and the table `schema_migrations` are
// those of dbmate. dbmate has no checksums, so they are in a separate table. Returns the present
// version of the schema.
Result<std::int64_t> migrate(PgConnection& connection, const std::vector<Migration>& known);

}  // namespace strata::store
