#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "store/pg/pg.h"

namespace strata::store {

struct Migration {
  std::string version;      // the digits before the first underscore of the file name: "000001"
  std::string name;         // name of the file
  std::string sql;          // text between `-- migrate:up` and `-- migrate:down` or the end
  std::string sha256;       // hash of the whole file, lower-case hex
  std::int64_t number = 0;  // `version` as a number
  // N of the line `-- readable-from: N`: programs whose newest migration is N, or a later one, can
  // use the database after this migration. `number` without the line.
  std::int64_t readable_from = 0;
};

// Returns the *.sql files of a folder in order of version. Returns an error for a file without `--
// migrate:up` or with a malformed line `-- readable-from: N`, and for two files with the same
// version.
Result<std::vector<Migration>> read_migrations(const std::filesystem::path& folder);

// The migrations that a database has, or will have.
struct Schema {
  std::map<std::int64_t, std::int64_t> readable_from_by_number;
  std::string applied_by;  // version of Strata that applied the newest one; may be empty

  std::int64_t version() const;  // number of the newest migration, or 0
  // Returns the smallest N for which every migration after N is readable from N or an earlier one.
  // A program whose newest migration is N or a later one can use the database.
  std::int64_t readable_from() const;
};

// Reads `schema_migrations`, also if an older program or dbmate wrote it. Returns an error if the
// table does not exist.
Result<Schema> read_schema(PgConnection& connection);

// Applies the missing migrations, and returns the current schema. Each file is one transaction,
// which inserts its version row first. An advisory lock allows any number of servers to start at
// the same time. A server waits up to `wait` for a server that has the lock, and then returns
// `unavailable`.
//
// If the database has migrations that are newer than all of `known`, applies nothing. Returns an
// error if one of them is not readable for a program with `known`. Also returns an error if the
// database has another migration that is not in `known`, or if an applied file differs from
// `known`. The file format and the table `schema_migrations` come from dbmate; the columns for
// `readable_from` and the version of Strata are added. dbmate has no checksums, so they are in a
// separate table.
Result<Schema> migrate(PgConnection& connection, const std::vector<Migration>& known,
                       std::chrono::milliseconds wait = std::chrono::minutes(10));

}  // namespace strata::store
