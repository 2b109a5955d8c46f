#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "core/error.h"
#include "core/progress.h"

// A whole site in a folder: `database.dump` in pg_dump's custom format, and `manifest.json`, which
// says what must be in it. Everything durable is in PostgreSQL, so nothing else is needed to have
// the site again.
namespace strata::store {

struct BackupFacts {
  std::string made;  // UTC, ISO 8601
  std::int64_t schema_version = 0;
  std::string server_version;  // of PostgreSQL
  std::uint64_t bytes = 0;     // of the dump
  std::string sha256;          // of the dump, hexadecimal
  struct Table {
    std::int64_t rows = 0;
    std::string digest;  // a sum over the rows' contents, whatever their order
    bool operator==(const Table&) const = default;
  };
  std::map<std::string, Table> tables;            // by schema-qualified name
  std::map<std::string, std::int64_t> sequences;  // the last number that each had given

  std::int64_t rows_of(const std::string& table) const;  // 0: no such table
};

// Of the database as it is at one moment, also while a server writes into it. The folder must not
// be there yet; it appears when all is written and read over once, so that one which is there is
// whole. conflict: it is there; storage_full: the disk is full.
Result<BackupFacts> write_backup(const std::string& dsn, const std::filesystem::path& folder,
                                 Progress& progress);

// That the folder holds a backup whose dump is, byte for byte, what was written. not_found: it
// holds none; invalid: it is damaged.
Result<BackupFacts> check_backup(const std::filesystem::path& folder, Progress& progress);

// Into an empty database, all or nothing, and compares every table with what was backed up.
// conflict: the database is not empty; invalid: what came out is not what went in.
Result<void> restore_backup(const std::filesystem::path& folder, const BackupFacts& facts,
                            const std::string& dsn, Progress& progress);

}  // namespace strata::store
