#pragma once

#include <filesystem>
#include <functional>

#include "core/digest.h"
#include "store/pg/pool.h"

namespace strata::store {

inline constexpr std::size_t kChunkBytes = 1u << 20;

// Large content (a blob), stored by its SHA-256 in chunks. All functions run in the transaction of
// the caller, and lock the row of the blob against deletion until the transaction ends. `cancelled`
// is called once per chunk. Store several blobs in the order of their hashes, so that concurrent
// imports and deletions of the same blobs cannot deadlock.
struct Content {
  Sha256 hash{};
  std::int64_t bytes = 0;
  Bytes memory;                // the content, or empty
  std::filesystem::path file;  // the file with the content
};
Content content_of(Bytes memory);
Result<Content> content_of(const std::filesystem::path& file,
                           const std::function<bool()>& cancelled);
Result<void> keep_blob(PgConnection& connection, const Content& content,
                       const std::function<bool()>& cancelled);

Result<std::vector<std::uint8_t>> read_blob(PgConnection& connection, Bytes sha256,
                                            std::int64_t bytes);

// Passes the bytes from `begin` up to, but not including, `end` to `sink`, in pieces of at most
// kChunkBytes, until `sink` returns false. Each piece is a separate query, so a slow reader does
// not occupy a connection. Returns a `not_found` error if the blob is deleted during the call.
Result<void> stream_blob(Pool& pool, const std::vector<std::uint8_t>& sha256, std::uint64_t begin,
                         std::uint64_t end, const std::function<bool(Bytes)>& sink);

// Deletes the given blobs if they are no longer used.
Result<void> drop_unused(PgConnection& connection,
                         const std::vector<std::vector<std::uint8_t>>& hashes);
// Deletes all unused blobs, except those that another transaction is about to use. Returns the
// number of deleted blobs.
Result<std::int64_t> drop_all_unused(PgConnection& connection);

}  // namespace strata::store
