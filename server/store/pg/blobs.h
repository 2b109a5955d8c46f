#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "store/files/file_store.h"
#include "store/pg/pool.h"

namespace strata::store {

// Large content (a blob), stored by its SHA-256: in chunks in the database, or in the file store.
//
// A writer calls `upload` before its transaction, and `keep_blob` in it. Both place the content in
// the database if it cannot be in the file store. The transaction of `upload` creates the row of
// the blob, so the sweep (store/files/files.h) knows each file whose transaction never commits.
class Blobs {
 public:
  explicit Blobs(Pool& pool) : pool_(pool) {}

  // Sets the file store. Call before other threads use this object.
  void use(std::unique_ptr<FileStore> files) { files_ = std::move(files); }
  FileStore* files() const { return files_.get(); }  // null: all new content is in the database
  Result<bool> owns_files();                         // see Files

  // Stores the contents in the file store, if there is one and this database owns it. Call it
  // before the transaction that needs them, because an upload may take long. The errors of the file
  // store are logged, and returned without the names of folders and accounts.
  Result<void> upload(std::span<Content> contents, const std::function<bool()>& cancelled);
  Result<void> upload(Content& content) { return upload({&content, 1}, {}); }
  // Ends all uploads soon, because the server stops.
  void stop_uploads() { is_stopping_ = true; }

  // Returns the whole content.
  Result<std::vector<std::uint8_t>> read(Bytes sha256);
  // Passes the bytes from `begin` up to, but not including, `end` or the end of the content to
  // `sink`, in pieces of at most kChunkBytes, until `sink` returns false. Does not occupy a
  // connection while `sink` waits for a slow reader. Returns a `not_found` error if the blob does
  // not exist, and `damaged` if its file is missing or has other bytes. Bytes of a file are passed
  // only after their hash was checked.
  Result<void> stream(Bytes sha256, std::uint64_t begin, std::uint64_t end,
                      const std::function<bool(Bytes)>& sink);

  // The numbers of failed reads of files, since the start.
  struct Faults {
    std::atomic<std::uint64_t> missing{0}, changed{0}, unreachable{0};
  };
  const Faults& faults() const { return faults_; }

 private:
  struct Place;
  Result<std::optional<Place>> find(Bytes sha256);
  Result<bool> stream_rows(Bytes sha256, std::uint64_t& at, std::uint64_t end,
                           const std::function<bool(Bytes)>& sink);
  Result<bool> stream_file(Bytes sha256, const Place& place, std::uint64_t& at, std::uint64_t end,
                           const std::function<bool(Bytes)>& sink);

  Error without_names(Error error);

  Pool& pool_;
  std::unique_ptr<FileStore> files_;
  std::atomic<bool> is_stopping_ = false;
  std::mutex log_mutex_;
  std::chrono::steady_clock::time_point log_after_;
  Faults faults_;
};

// Keeps the content in the transaction of the caller, and locks the row of the blob against
// deletion until the transaction ends. Store several blobs in the order of their hashes, so that
// concurrent imports and deletions of the same blobs cannot deadlock.
Result<void> keep_blob(PgConnection& connection, const Content& content,
                       const std::function<bool()>& cancelled);

// Deletes the given blobs if they are no longer used. The sweep deletes blobs with files.
Result<void> drop_unused(PgConnection& connection,
                         const std::vector<std::vector<std::uint8_t>>& hashes);
// Deletes all unused blobs in the database, except those that another transaction is about to use.
// Returns the number of deleted blobs.
Result<std::int64_t> drop_all_unused(PgConnection& connection);

// SQL: nothing uses the blob `b`.
inline constexpr auto kIsUnused =
    sql("NOT EXISTS (SELECT 1 FROM all_models WHERE geometry = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM detail_levels d WHERE d.geometry = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM model_sources s WHERE s.sha256 = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM looks WHERE picture = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM attachments a WHERE a.sha256 = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM tour_files f WHERE f.sha256 = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM photographs p WHERE p.sha256 = b.sha256)");

// Writes the chunks of a blob that has a row but no chunks.
Result<void> write_chunks(PgConnection& connection, const Content& content,
                          const std::function<bool()>& cancelled);

}  // namespace strata::store
