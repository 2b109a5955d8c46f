#include "store/pg/blobs.h"

#include <algorithm>
#include <fstream>

#include "core/progress.h"
#include "store/pg/sql.h"

namespace strata::store {
namespace {

// Returns the next chunk, which is empty at the end.
using NextChunk = std::function<Result<Bytes>()>;

Result<void> copy_chunks(PgConnection& connection, const Sha256& hash, const NextChunk& next) {
  if (auto begun = connection.copy_begin(
          "COPY blob_chunks (sha256, chunk, data) FROM STDIN (FORMAT binary)");
      !begun)
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
    STRATA_TRY(connection.copy_send(row));
  }
}

// Returns true if the blob is new and its chunks must be written.
Result<bool> claim(PgConnection& connection, const Sha256& hash, std::int64_t bytes) {
  for (;;) {
    auto made =
        connection.query("INSERT INTO blobs (sha256, bytes) VALUES ($1, $2) ON CONFLICT DO NOTHING",
                         Params().bytes(hash).integer(bytes));
    if (!made) return tl::unexpected(made.error());
    if (made->affected() > 0) return true;
    auto held = STRATA_TRY(connection.query("SELECT 1 FROM blobs WHERE sha256 = $1 FOR KEY SHARE",
                                            Params().bytes(hash)));
    if (held.rows() > 0) return false;
  }
}

}  // namespace

Content content_of(Bytes memory) {
  return {sha256(memory), static_cast<std::int64_t>(memory.size()), memory, {}};
}

namespace {

// Returns the next chunk of a file, which is empty at the end of the file.
Result<Bytes> next_chunk(std::ifstream& in, std::vector<std::uint8_t>& buffer,
                         const std::filesystem::path& file) {
  in.read(reinterpret_cast<char*>(buffer.data()), static_cast<std::streamsize>(buffer.size()));
  if (in.bad())
    return fail(ErrorCode::internal, "File not readable", "Cannot read " + file.string() + ".",
                "source_files");
  return Bytes(buffer).first(static_cast<std::size_t>(in.gcount()));
}

}  // namespace

// Hashes a file before it is sent, so that a scan that is already stored is not sent again.
Result<Content> content_of(const std::filesystem::path& file,
                           const std::function<bool()>& cancelled) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    return fail(ErrorCode::internal, "File not readable", "Cannot open " + file.string() + ".",
                "source_files");
  std::vector<std::uint8_t> buffer(kChunkBytes);
  Sha256Stream stream;
  Content content;
  content.file = file;
  for (;;) {
    if (cancelled && cancelled()) return cancelled_problem();
    auto chunk = STRATA_TRY(next_chunk(in, buffer, file));
    if (chunk.empty()) break;
    stream.add(chunk);
    content.bytes += static_cast<std::int64_t>(chunk.size());
  }
  content.hash = stream.finish();
  return content;
}

Result<void> keep_blob(PgConnection& connection, const Content& content,
                       const std::function<bool()>& cancelled) {
  auto fresh = STRATA_TRY(claim(connection, content.hash, content.bytes));
  if (!fresh) return {};
  if (content.file.empty()) {
    Bytes rest = content.memory;
    return copy_chunks(connection, content.hash, [&]() -> Result<Bytes> {
      if (cancelled && cancelled()) return cancelled_problem();
      const Bytes chunk = rest.first(std::min(rest.size(), kChunkBytes));
      rest = rest.subspan(chunk.size());
      return chunk;
    });
  }
  std::ifstream in(content.file, std::ios::binary);
  std::vector<std::uint8_t> buffer(kChunkBytes);
  Sha256Stream stream;
  auto written = copy_chunks(connection, content.hash, [&]() -> Result<Bytes> {
    if (cancelled && cancelled()) return cancelled_problem();
    auto chunk = next_chunk(in, buffer, content.file);
    if (chunk) stream.add(*chunk);
    return chunk;
  });
  if (written && stream.finish() != content.hash)
    return fail(ErrorCode::conflict, "File changed",
                content.file.string() + " changed while it was read. Import it again.",
                "source_files");
  return written;
}

Result<std::vector<std::uint8_t>> read_blob(PgConnection& connection, Bytes sha256,
                                            std::int64_t bytes) {
  std::vector<std::uint8_t> content;
  content.reserve(static_cast<std::size_t>(bytes));
  STRATA_TRY(connection.each_row("SELECT data FROM blob_chunks WHERE sha256 = $1 ORDER BY chunk",
                                 Params().bytes(sha256), [&](const PgResult& row) -> Result<void> {
                                   const Bytes chunk = row.bytes(0, 0);
                                   content.insert(content.end(), chunk.begin(), chunk.end());
                                   return {};
                                 }));
  if (content.size() != static_cast<std::size_t>(bytes))
    return fail(ErrorCode::internal, "Damaged content",
                "The stored content is incomplete. Restore the database from a backup.");
  return content;
}

Result<void> stream_blob(Pool& pool, const std::vector<std::uint8_t>& sha256, std::uint64_t begin,
                         std::uint64_t end, const std::function<bool(Bytes)>& sink) {
  for (std::uint64_t at = begin; at < end;) {
    auto chunk = STRATA_TRY(pool.read([&](PgConnection& connection) {
      return connection.query(
          "SELECT data FROM blob_chunks WHERE sha256 = $1 AND chunk = $2",
          Params().bytes(sha256).integer(static_cast<std::int64_t>(at / kChunkBytes)));
    }));
    const std::size_t skipped = at % kChunkBytes;
    if (chunk.rows() == 0 || chunk.bytes(0, 0).size() <= skipped)
      return fail(ErrorCode::not_found, "Not found",
                  "Somebody deleted the file while the server was reading it.");
    Bytes piece = chunk.bytes(0, 0).subspan(skipped);
    piece = piece.first(static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), end - at)));
    if (!sink(piece)) break;
    at += piece.size();
  }
  return {};
}

constexpr auto kIsUnused =
    sql("NOT EXISTS (SELECT 1 FROM all_models WHERE geometry = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM detail_levels d WHERE d.geometry = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM model_sources s WHERE s.sha256 = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM looks WHERE picture = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM attachments a WHERE a.sha256 = b.sha256) "
        "AND NOT EXISTS (SELECT 1 FROM tour_files f WHERE f.sha256 = b.sha256)");

Result<void> drop_unused(PgConnection& connection,
                         const std::vector<std::vector<std::uint8_t>>& hashes) {
  PgArray list(oid::kBytea);
  for (const auto& hash : hashes) list.add(Bytes(hash));
  // Lock first. If two models are deleted at the same time, the second deletion waits for the
  // first, and then finds that the first model is deleted.
  auto locked =
      connection.query("SELECT 1 FROM blobs WHERE sha256 = any($1) ORDER BY sha256 FOR UPDATE",
                       Params().array(list));
  if (!locked) return tl::unexpected(locked.error());
  auto done = connection.query(sql("DELETE FROM blobs b WHERE sha256 = any($1) AND ", kIsUnused),
                               Params().array(list));
  return done ? Result<void>{} : tl::unexpected(done.error());
}

Result<std::int64_t> drop_all_unused(PgConnection& connection) {
  auto locked = STRATA_TRY(connection.query(
      sql("SELECT sha256 FROM blobs b WHERE ", kIsUnused, " FOR UPDATE SKIP LOCKED")));
  PgArray list(oid::kBytea);
  for (int i = 0; i < locked.rows(); ++i) list.add(locked.bytes(i, 0));
  auto done = STRATA_TRY(connection.query(
      sql("DELETE FROM blobs b WHERE sha256 = any($1) AND ", kIsUnused), Params().array(list)));
  return done.affected();
}

}  // namespace strata::store
