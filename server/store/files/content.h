#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "core/digest.h"
#include "core/error.h"
#include "store/pg/bytes.h"

namespace strata::store {

inline constexpr std::size_t kChunkBytes = 1u << 20;

// Large content that the server stores by its SHA-256.
struct Content {
  Sha256 hash{};
  std::int64_t bytes = 0;
  Bytes memory;                // the content, or empty
  std::filesystem::path file;  // the file with the content
  // When the upload to the file store began, if it succeeded (store/pg/blobs.h).
  std::optional<std::chrono::steady_clock::time_point> uploaded{};
};
Sha256 sha256_of(Bytes hash);  // of a column of 32 bytes
Content content_of(Bytes memory);
// Hashes the file before it is sent, so that a scan that is in the database is not sent again.
Result<Content> content_of(const std::filesystem::path& file,
                           const std::function<bool()>& cancelled);

// Passes the content to `sink`, in pieces of kChunkBytes; only the last one may be shorter. Stops
// at the first error of `sink`. `cancelled` is called once per piece. Returns a `conflict` error if
// the content no longer has its hash, because its file changed.
Result<void> each_chunk(const Content& content, const std::function<bool()>& cancelled,
                        const std::function<Result<void>(Bytes)>& sink);

// Returns the SHA-256 of each chunk, one after the other.
Result<std::vector<std::uint8_t>> chunk_sums_of(const Content& content,
                                                const std::function<bool()>& cancelled);

}  // namespace strata::store
