#pragma once

#include <filesystem>
#include <functional>

#include "store/hash.h"
#include "store/pg.h"

namespace strata::store {

inline constexpr std::size_t kChunkBytes = 1u << 20;

// Large content by its SHA-256, in chunks. All run inside the caller's transaction and leave the blob's row locked
// against deletion until it ends. `cancelled` is asked once a chunk.
Result<Sha256> keep_blob(PgConnection& connection, Bytes content, const std::function<bool()>& cancelled);
Result<Sha256> keep_file(PgConnection& connection, const std::filesystem::path& file, const std::string& field,
                         const std::function<bool()>& cancelled);

Result<std::vector<std::uint8_t>> read_blob(PgConnection& connection, Bytes sha256, std::int64_t bytes);

// Deletes those of the blobs that no model uses any more.
Result<void> drop_unused(PgConnection& connection, const std::vector<std::vector<std::uint8_t>>& hashes);

}  // namespace strata::store
