#pragma once

#include <filesystem>
#include <functional>

#include "core/digest.h"
#include "store/pg/pool.h"

namespace strata::store {

inline constexpr std::size_t kChunkBytes = 1u << 20;

// Large content by its SHA-256, in chunks. All run inside the caller's transaction and leave the
// blob's row locked against deletion until it ends. `cancelled` is asked once a chunk. Keep several
// in the order of their hashes: then two imports and deletions of the same ones cannot wait for
// each other.
struct Content {
  Sha256 hash{};
  std::int64_t bytes = 0;
  Bytes memory;                // the content, or
  std::filesystem::path file;  // where it is
};
Content content_of(Bytes memory);
Result<Content> content_of(const std::filesystem::path& file,
                           const std::function<bool()>& cancelled);
Result<void> keep_blob(PgConnection& connection, const Content& content,
                       const std::function<bool()>& cancelled);

Result<std::vector<std::uint8_t>> read_blob(PgConnection& connection, Bytes sha256,
                                            std::int64_t bytes);

// Hands out the bytes from `begin` to before `end` in pieces of kChunkBytes at most, until `sink`
// returns false. One query a piece: a slow reader holds no connection while it reads. `not_found`
// where the blob goes meanwhile.
Result<void> stream_blob(Pool& pool, const std::vector<std::uint8_t>& sha256, std::uint64_t begin,
                         std::uint64_t end, const std::function<bool(Bytes)>& sink);

// Deletes those of the blobs that nothing uses any more.
Result<void> drop_unused(PgConnection& connection,
                         const std::vector<std::vector<std::uint8_t>>& hashes);
// All such blobs, but for those that somebody is about to use. Returns how many.
Result<std::int64_t> drop_all_unused(PgConnection& connection);

}  // namespace strata::store
