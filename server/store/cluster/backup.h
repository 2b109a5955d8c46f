#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "core/error.h"
#include "core/progress.h"

// A backup of a whole site in a folder: `database.dump` in pg_dump's custom format, and
// `manifest.json`, which lists the expected contents. Everything durable is in PostgreSQL, so
// nothing else is needed to restore the site.
namespace strata::store {

struct BackupFacts {
  std::string made;  // UTC, ISO 8601
  std::int64_t schema_version = 0;
  std::string server_version;  // of PostgreSQL
  std::uint64_t bytes = 0;     // of the dump
  std::string sha256;          // of the dump, hexadecimal
  struct Table {
    std::int64_t rows = 0;
    std::string digest;  // a sum over the contents of the rows that does not depend on their order
    bool operator==(const Table&) const = default;
  };
  std::map<std::string, Table> tables;            // by schema-qualified name
  std::map<std::string, std::int64_t> sequences;  // the last number that each returned

  std::int64_t rows_of(const std::string& table) const;  // 0: no such table
};

// Backs up the database as it is at one moment, also while a server writes into it. The folder must
// not exist; it appears only when everything is written and was read once, so an existing folder is
// complete. conflict: the folder exists; storage_full: the disk is full.
Result<BackupFacts> write_backup(const std::string& dsn, const std::filesystem::path& folder,
                                 Progress& progress);

// Checks that the folder holds a backup whose dump is unchanged, byte for byte. not_found: the
// folder holds no backup; invalid: the backup is damaged.
Result<BackupFacts> check_backup(const std::filesystem::path& folder, Progress& progress);

// Restores into an empty database, all or nothing, and compares every table with the backup.
// conflict: the database is not empty; invalid: the result differs from the backup.
Result<void> restore_backup(const std::filesystem::path& folder, const BackupFacts& facts,
                            const std::string& dsn, Progress& progress);

}  // namespace strata::store
