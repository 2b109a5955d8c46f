#pragma once

#include <filesystem>
#include <functional>

#include "store/hash.h"
#include "store/pg.h"

namespace strata::store {

inline constexpr std::size_t kChunkBytes = 1u << 20;

// Large content by its SHA-256, in chunks. All run inside the caller's transaction and leave the blob's row locked
// against deletion until it ends. `cancelled` is asked once a chunk.
// Keep several in the order of their hashes: then two imports and deletions of the same ones cannot wait for each other.
struct Content {
  Sha256 hash{};
  std::int64_t bytes = 0;
  Bytes memory;                // the content, or
  std::filesystem::path file;  // where it is
};
Content content_of(Bytes memory);
Result<Content> content_of(const std::filesystem::path& file, const std::function<bool()>& cancelled);
Result<void> keep_blob(PgConnection& connection, const Content& content, const std::function<bool()>& cancelled);

Result<std::vector<std::uint8_t>> read_blob(PgConnection& connection, Bytes sha256, std::int64_t bytes);

// Deletes those of the blobs that no model uses any more.
Result<void> drop_unused(PgConnection& connection, const std::vector<std::vector<std::uint8_t>>& hashes);

}  // namespace strata::store
