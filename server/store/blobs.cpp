#include "store/blobs.h"

#include <fstream>

#include "core/progress.h"

namespace strata::store {
namespace {

// Fills the buffer with the next chunk; empty at the end.
using NextChunk = std::function<Result<Bytes>()>;

Result<void> copy_chunks(PgConnection& connection, const Sha256& hash, const NextChunk& next) {
  if (auto begun = connection.copy_begin("COPY blob_chunks (sha256, chunk, data) FROM STDIN (FORMAT binary)"); !begun)
    return begun;
  for (std::int32_t number = 0;; ++number) {
    auto chunk = next();
    if (!chunk) {
      connection.copy_abort("stopped by Strata");
      return tl::unexpected(chunk.error());
    }
    if (chunk->empty()) return connection.copy_end();
    std::string row;
    row.reserve(chunk->size() + 64);
    append_row_start(row, 3);
    append_field(row, hash);
    append_int4(row, number);
    append_field(row, *chunk);
    if (auto sent = connection.copy_send(row); !sent) return sent;
  }
}

// True when the blob is new and its chunks must be written.
Result<bool> claim(PgConnection& connection, const Sha256& hash, std::int64_t bytes) {
  for (;;) {
    auto made = connection.query("INSERT INTO blobs (sha256, bytes) VALUES ($1, $2) ON CONFLICT DO NOTHING",
                                 Params().bytes(hash).integer(bytes));
    if (!made) return tl::unexpected(made.error());
    if (made->affected() > 0) return true;
    auto held = connection.query("SELECT 1 FROM blobs WHERE sha256 = $1 FOR KEY SHARE", Params().bytes(hash));
    if (!held) return tl::unexpected(held.error());
    if (held->rows() > 0) return false;
  }
}

}  // namespace

Result<Sha256> keep_blob(PgConnection& connection, Bytes content, const std::function<bool()>& cancelled) {
  const Sha256 hash = sha256(content);
  auto fresh = claim(connection, hash, static_cast<std::int64_t>(content.size()));
  if (!fresh) return tl::unexpected(fresh.error());
  if (!*fresh) return hash;
  auto written = copy_chunks(connection, hash, [&]() -> Result<Bytes> {
    if (cancelled && cancelled()) return cancelled_problem();
    const Bytes chunk = content.first(std::min(content.size(), kChunkBytes));
    content = content.subspan(chunk.size());
    return chunk;
  });
  if (!written) return tl::unexpected(written.error());
  return hash;
}

Result<Sha256> keep_file(PgConnection& connection, const std::filesystem::path& file, const std::string& field,
                         const std::function<bool()>& cancelled) {
  std::ifstream in(file, std::ios::binary);
  std::vector<std::uint8_t> buffer(kChunkBytes);
  std::int64_t bytes = 0;
  const auto unreadable = [&] { return fail(500, "File not readable", "Cannot read " + file.string() + ".", field); };
  const NextChunk next = [&]() -> Result<Bytes> {
    if (cancelled && cancelled()) return cancelled_problem();
    in.read(reinterpret_cast<char*>(buffer.data()), static_cast<std::streamsize>(buffer.size()));
    if (in.bad()) return unreadable();
    return Bytes(buffer).first(static_cast<std::size_t>(in.gcount()));
  };
  if (!in) return unreadable();

  // Hashed first: a scan that is kept already is not sent again.
  Sha256Stream first;
  for (;;) {
    auto chunk = next();
    if (!chunk) return tl::unexpected(chunk.error());
    if (chunk->empty()) break;
    first.add(*chunk);
    bytes += static_cast<std::int64_t>(chunk->size());
  }
  const Sha256 hash = first.finish();
  auto fresh = claim(connection, hash, bytes);
  if (!fresh) return tl::unexpected(fresh.error());
  if (!*fresh) return hash;
  in.clear();
  in.seekg(0);
  Sha256Stream second;
  auto written = copy_chunks(connection, hash, [&]() -> Result<Bytes> {
    auto chunk = next();
    if (chunk) second.add(*chunk);
    return chunk;
  });
  if (!written) return tl::unexpected(written.error());
  if (second.finish() != hash)
    return fail(409, "File changed", file.string() + " changed while it was read. Import it again.", field);
  return hash;
}

Result<std::vector<std::uint8_t>> read_blob(PgConnection& connection, Bytes sha256, std::int64_t bytes) {
  std::vector<std::uint8_t> content;
  content.reserve(static_cast<std::size_t>(bytes));
  auto read = connection.each_row("SELECT data FROM blob_chunks WHERE sha256 = $1 ORDER BY chunk", Params().bytes(sha256),
                                  [&](const PgResult& row) -> Result<void> {
                                    const Bytes chunk = row.bytes(0, 0);
                                    content.insert(content.end(), chunk.begin(), chunk.end());
                                    return {};
                                  });
  if (!read) return tl::unexpected(read.error());
  if (content.size() != static_cast<std::size_t>(bytes))
    return fail(500, "Damaged content", "Stored content is incomplete: restore the database from a backup.");
  return content;
}

Result<void> drop_unused(PgConnection& connection, const std::vector<std::vector<std::uint8_t>>& hashes) {
  PgArray list(oid::kBytea);
  for (const auto& hash : hashes) list.add(Bytes(hash));
  auto done = connection.query("DELETE FROM blobs b WHERE sha256 = any($1) "
                               "AND NOT EXISTS (SELECT 1 FROM models WHERE geometry = b.sha256) "
                               "AND NOT EXISTS (SELECT 1 FROM model_sources s WHERE s.sha256 = b.sha256)",
                               Params().array(list));
  return done ? Result<void>{} : tl::unexpected(done.error());
}

}  // namespace strata::store
