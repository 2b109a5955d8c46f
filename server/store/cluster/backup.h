#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "core/error.h"
#include "core/progress.h"

// A backup of a whole site in a folder: `database.dump` in pg_dump's custom format, and
// `manifest.json`, which lists the expected contents. Everything durable is in PostgreSQL, so
// nothing else is needed to restore the site, except files outside the database
// (store/files/files.h).
namespace strata::store {

struct BackupFacts {
  std::string made;  // UTC, ISO 8601
  std::int64_t schema_version = 0;
  std::string server_version;  // the version of PostgreSQL
  std::uint64_t bytes = 0;     // size of the dump
  std::string sha256;          // hash of the dump, hexadecimal
  struct Table {
    std::int64_t rows = 0;
    std::string digest;  // a sum over the contents of the rows that does not depend on their order
    bool operator==(const Table&) const = default;
  };
  // The content outside the database, which is not in the backup.
  struct Files {
    std::int64_t count = 0, bytes = 0;
    std::string place;
  };
  Files files{};
  std::map<std::string, Table> tables;            // by schema-qualified name
  std::map<std::string, std::int64_t> sequences;  // the last number that each sequence returned

  std::int64_t rows_of(const std::string& table) const;  // 0 if the table does not exist
};

// Backs up the state of the database at one moment, even while a server writes to it. The folder
// must not exist. It appears only after the whole backup was written and checked, so an existing
// folder is complete. Returns a `conflict` error if the folder exists, and `storage_full` if the
// disk is full.
Result<BackupFacts> write_backup(const std::string& dsn, const std::filesystem::path& folder,
                                 Progress& progress);

// Checks that the folder contains a backup, and that no byte of its dump has changed. Returns a
// `not_found` error if the folder contains no backup, and `invalid` if the backup is damaged.
Result<BackupFacts> check_backup(const std::filesystem::path& folder, Progress& progress);

// Restores the backup into an empty database, completely or not at all, and compares every table
// with the backup. Returns a `conflict` error if the database is not empty, and `invalid` if the
// result differs from the backup.
Result<void> restore_backup(const std::filesystem::path& folder, const BackupFacts& facts,
                            const std::string& dsn, Progress& progress);

// Reads all tables and sequences of a database of Strata, to compare it with another one. There is
// no dump, so `bytes` and `sha256` are empty.
Result<BackupFacts> read_facts(const std::string& dsn, Progress& progress);
// Returns the first difference of a copy from the original, as a sentence that begins with a lower
// case letter. Returns an empty text if no difference exists. The sequences of the copy may have
// higher values.
std::string difference(const BackupFacts& expected, const BackupFacts& found);

}  // namespace strata::store
