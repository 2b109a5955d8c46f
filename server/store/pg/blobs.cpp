#include "store/pg/blobs.h"

#include <algorithm>

#include "core/log.h"
#include "core/progress.h"
#include "core/text/hex.h"
#include "store/files/files_mark.h"
#include "store/pg/sql.h"

namespace strata::store {
namespace {

// The size of one read from the file store. A multiple of kChunkBytes.
constexpr std::uint64_t kWindowBytes = 8 * kChunkBytes;
constexpr std::size_t kSumBytes = Sha256{}.size();
// A blob may move between the database and the file store while it is read.
constexpr int kMaxMoves = 10;
constexpr std::chrono::minutes kBetweenLogLines{1};

// The sweep may have deleted the file of a transaction that begins long after its upload. It
// keeps each file for at least a day.
constexpr std::chrono::hours kUploadLasts{12};
bool is_reliable(const Content& content) {
  return content.uploaded && std::chrono::steady_clock::now() - *content.uploaded < kUploadLasts;
}

// SQL: the row of the blob `b` can be deleted together with its content. For a day after the last
// request to delete the file of a blob, its row prevents a new upload, because the request may
// arrive late.
constexpr auto kMayDrop =
    sql("NOT is_outside AND (removing IS NULL OR removing < clock_timestamp() - interval '1 day') "
        "AND ",
        kIsUnused);

tl::unexpected<Error> damaged_rows() {
  return fail(ErrorCode::damaged, "Damaged content",
              "The stored content is incomplete. Restore the database from a backup.");
}

tl::unexpected<Error> deleted_during_read() {
  return fail(ErrorCode::not_found, "Not found",
              "Somebody deleted the file while the server was reading it.");
}

}  // namespace

struct Blobs::Place {
  std::uint64_t bytes = 0;
  bool is_outside = false;
  std::vector<std::uint8_t> chunk_sums;
};

Result<bool> Blobs::owns_files() {
  if (!files_) return false;
  const auto owner = STRATA_TRY(pool_.read([](PgConnection& connection) -> Result<std::string> {
    const auto row = STRATA_TRY(connection.query(
        sql("SELECT split_part(owner, '/', 3) FROM file_store WHERE starts_with(owner, ",
            kDatabaseId, " || '/')")));
    return row.rows() > 0 ? row.text(0, 0) : std::string();
  }));
  if (owner.empty()) return false;
  const auto text = STRATA_TRY(files_->read_mark());
  if (!text)
    return fail(ErrorCode::unavailable, "Files unavailable",
                files_->place() + " has no " + kFilesMark + ". Check that the disk is mounted.",
                "--files");
  const auto mark = parse_files_mark(*text);
  return mark && mark->owner == owner;
}

// Visitors of the site can cause such errors, and must not see names of folders, buckets and
// accounts.
Error Blobs::without_names(Error error) {
  const bool is_of_files = error.field == "--files";
  if (!is_of_files) return error;
  {
    const std::lock_guard lock(log_mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (now >= log_after_) {
      log_after_ = now + kBetweenLogLines;
      log::error("files outside the database: " + error.detail);
    }
  }
  error.detail = error.code == ErrorCode::storage_full
                     ? "The file store is full. Ask an administrator to free some space."
                     : "The file store does not respond. Ask an administrator.";
  error.field.clear();
  return error;
}

Result<void> Blobs::upload(std::span<Content> contents, const std::function<bool()>& cancelled) {
  if (!files_ || contents.empty()) return {};
  // Otherwise the owner of the files would find a file that it does not know, and delete it.
  const auto owns = owns_files();
  if (!owns) return tl::unexpected(without_names(owns.error()));
  if (!*owns) return {};
  const auto ending = [&] { return is_stopping_ || (cancelled && cancelled()); };
  for (Content& content : contents) {
    if (content.uploaded || static_cast<std::uint64_t>(content.bytes) > files_->max_bytes())
      continue;
    const auto sums = STRATA_TRY(chunk_sums_of(content, ending));
    const auto now = std::chrono::steady_clock::now();
    const auto reserved = STRATA_TRY(pool_.write([&](PgConnection& connection) {
      return connection.query(
          "INSERT INTO blobs (sha256, bytes, is_outside, chunk_sums, unused) "
          "VALUES ($1, $2, true, $3, clock_timestamp()) "
          // The sweep knows only the size of a superfluous file, which may be damaged.
          "ON CONFLICT (sha256) DO UPDATE SET unused = clock_timestamp(), "
          "bytes = excluded.bytes, chunk_sums = excluded.chunk_sums "
          "WHERE blobs.is_outside AND blobs.removing IS NULL",
          Params().bytes(content.hash).integer(content.bytes).bytes(sums));
    }));
    // Otherwise the content is in the database, or a file is being removed.
    if (reserved.affected() == 0) continue;
    // Upload even if the file exists, because it may be damaged or unfinished.
    if (const auto stored = files_->put(content, ending); !stored)
      return tl::unexpected(without_names(stored.error()));
    content.uploaded = now;
  }
  return {};
}

Result<std::optional<Blobs::Place>> Blobs::find(Bytes sha256) {
  return pool_.read([&](PgConnection& connection) -> Result<std::optional<Place>> {
    const auto row =
        STRATA_TRY(connection.query("SELECT bytes, is_outside, coalesce(chunk_sums, '') FROM blobs "
                                    "WHERE sha256 = $1",
                                    Params().bytes(sha256)));
    if (row.rows() == 0) return std::optional<Place>();
    const Bytes sums = row.bytes(0, 2);
    return std::optional(Place{static_cast<std::uint64_t>(row.integer(0, 0)),
                               row.boolean(0, 1),
                               {sums.begin(), sums.end()}});
  });
}

Result<std::vector<std::uint8_t>> Blobs::read(Bytes sha256) {
  const auto place = STRATA_TRY(find(sha256));
  if (!place) return deleted_during_read();
  std::vector<std::uint8_t> content;
  content.reserve(place->bytes);
  if (!place->is_outside) {
    // One query is faster than one for each chunk.
    const auto read = pool_.read([&](PgConnection& connection) {
      content.clear();
      return connection.each_row("SELECT data FROM blob_chunks WHERE sha256 = $1 ORDER BY chunk",
                                 Params().bytes(sha256), [&](const PgResult& row) -> Result<void> {
                                   const Bytes chunk = row.bytes(0, 0);
                                   content.insert(content.end(), chunk.begin(), chunk.end());
                                   return {};
                                 });
    });
    if (!read) return tl::unexpected(read.error());
    if (content.size() == place->bytes) return content;
  }
  content.clear();
  STRATA_TRY(stream(sha256, 0, place->bytes, [&](Bytes piece) {
    content.insert(content.end(), piece.begin(), piece.end());
    return true;
  }));
  if (content.size() != place->bytes) return damaged_rows();
  return content;
}

Result<void> Blobs::stream(Bytes sha256, std::uint64_t begin, std::uint64_t end,
                           const std::function<bool(Bytes)>& sink) {
  std::uint64_t at = begin;
  for (int moves = 0;; ++moves) {
    const auto place = STRATA_TRY(find(sha256));
    if (!place)
      return fail(ErrorCode::not_found, "Not found",
                  "There is no such file, or somebody deleted it while the server was reading it.");
    end = std::min(end, place->bytes);
    if (at >= end) return {};
    const bool done = STRATA_TRY(place->is_outside ? stream_file(sha256, *place, at, end, sink)
                                                   : stream_rows(sha256, at, end, sink));
    if (done) return {};
    const auto now = STRATA_TRY(find(sha256));
    if (now && now->is_outside != place->is_outside && moves < kMaxMoves) continue;
    if (!now) return deleted_during_read();
    if (!place->is_outside) return damaged_rows();
    ++faults_.missing;
    const std::string name = file_name_of(sha256_of(sha256));
    log::error("the file " + name + " is missing in " + files_->place());
    return fail(
        ErrorCode::damaged, "File missing",
        "The file " + name + " is missing. Copy it from a backup, or upload the same file again.");
  }
}

// Both functions return false if the content is not there. `at` is the place of the next byte.
Result<bool> Blobs::stream_rows(Bytes sha256, std::uint64_t& at, std::uint64_t end,
                                const std::function<bool(Bytes)>& sink) {
  while (at < end) {
    auto chunk = STRATA_TRY(pool_.read([&](PgConnection& connection) {
      return connection.query(
          "SELECT data FROM blob_chunks WHERE sha256 = $1 AND chunk = $2",
          Params().bytes(sha256).integer(static_cast<std::int64_t>(at / kChunkBytes)));
    }));
    const std::size_t skipped = at % kChunkBytes;
    if (chunk.rows() == 0 || chunk.bytes(0, 0).size() <= skipped) return false;
    Bytes piece = chunk.bytes(0, 0).subspan(skipped);
    piece = piece.first(static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), end - at)));
    if (!sink(piece)) return true;
    at += piece.size();
  }
  return true;
}

Result<bool> Blobs::stream_file(Bytes sha256, const Place& place, std::uint64_t& at,
                                std::uint64_t end, const std::function<bool(Bytes)>& sink) {
  const Sha256 hash = sha256_of(sha256);
  if (!files_)
    return fail(ErrorCode::unavailable, "Files unavailable",
                "The file " + file_name_of(hash) +
                    " is outside the database. Specify the folder or bucket with --files.");
  while (at < end) {
    const std::uint64_t first = at / kChunkBytes * kChunkBytes;
    const std::uint64_t last =
        std::min((end + kChunkBytes - 1) / kChunkBytes * kChunkBytes, place.bytes);
    const auto size = static_cast<std::size_t>(std::min(last - first, kWindowBytes));
    auto window = files_->read(hash, first, size);
    if (!window && window.error().code == ErrorCode::not_found) return false;
    if (!window) {
      ++faults_.unreachable;
      return tl::unexpected(without_names(window.error()));
    }
    for (std::size_t offset = 0; offset < size && at < end; offset += kChunkBytes) {
      const std::size_t wanted = std::min(size - offset, kChunkBytes);
      const std::size_t sum_at = (first + offset) / kChunkBytes * kSumBytes;
      const Bytes chunk = Bytes(*window).subspan(
          std::min(offset, window->size()),
          std::min(wanted, window->size() - std::min(offset, window->size())));
      if (chunk.size() != wanted || sum_at + kSumBytes > place.chunk_sums.size() ||
          strata::sha256(chunk) != sha256_of(Bytes(place.chunk_sums).subspan(sum_at, kSumBytes))) {
        ++faults_.changed;
        const std::string name = file_name_of(hash);
        log::error("the file " + name + " in " + files_->place() + " has changed");
        return fail(ErrorCode::damaged, "File changed",
                    "The content of the file " + name +
                        " has changed since it was stored, so the server does not send it. Copy it "
                        "from a backup, or upload the same file again.");
      }
      const std::uint64_t chunk_begin = first + offset;
      const std::size_t skipped = static_cast<std::size_t>(at - chunk_begin);
      const Bytes piece = chunk.subspan(skipped, static_cast<std::size_t>(std::min<std::uint64_t>(
                                                     chunk.size() - skipped, end - at)));
      if (!sink(piece)) return true;
      at += piece.size();
    }
  }
  return true;
}

Result<void> write_chunks(PgConnection& connection, const Content& content,
                          const std::function<bool()>& cancelled) {
  STRATA_TRY(
      connection.copy_begin("COPY blob_chunks (sha256, chunk, data) FROM STDIN (FORMAT binary)"));
  std::int32_t number = 0;
  // A connection that refuses data ends the copy itself.
  bool was_refused = false;
  auto sent = each_chunk(content, cancelled, [&](Bytes chunk) -> Result<void> {
    std::string row;
    row.reserve(chunk.size() + 64);
    append_row_start(row, 3);
    append_field(row, content.hash);
    append_int4(row, number++);
    append_field(row, chunk);
    auto taken = connection.copy_send(row);
    was_refused = !taken;
    return taken;
  });
  if (sent) return connection.copy_end();
  if (!was_refused) connection.copy_abort("stopped by Strata");
  return sent;
}

Result<void> keep_blob(PgConnection& connection, const Content& content,
                       const std::function<bool()>& cancelled) {
  for (;;) {
    auto made =
        connection.query("INSERT INTO blobs (sha256, bytes) VALUES ($1, $2) ON CONFLICT DO NOTHING",
                         Params().bytes(content.hash).integer(content.bytes));
    if (!made) return tl::unexpected(made.error());
    if (made->affected() > 0) return write_chunks(connection, content, cancelled);
    auto held = STRATA_TRY(connection.query(
        "SELECT is_outside, removing IS NULL FROM blobs WHERE sha256 = $1 FOR KEY SHARE",
        Params().bytes(content.hash)));
    if (held.rows() == 0) continue;
    const bool is_outside = held.boolean(0, 0), stays = held.boolean(0, 1);
    if (!is_outside || (stays && is_reliable(content))) return {};
    // The file may be missing, or the sweep is removing it.
    auto taken_in = STRATA_TRY(connection.query(
        "UPDATE blobs SET is_outside = false, bytes = $2, chunk_sums = NULL, "
        "unused = CASE WHEN removing IS NULL THEN clock_timestamp() ELSE unused END, "
        "removing = coalesce(removing, clock_timestamp()) WHERE sha256 = $1 AND is_outside",
        Params().bytes(content.hash).integer(content.bytes)));
    if (taken_in.affected() > 0) return write_chunks(connection, content, cancelled);
  }
}

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
  auto done = connection.query(sql("DELETE FROM blobs b WHERE sha256 = any($1) AND ", kMayDrop),
                               Params().array(list));
  return done ? Result<void>{} : tl::unexpected(done.error());
}

Result<std::int64_t> drop_all_unused(PgConnection& connection) {
  auto locked = STRATA_TRY(connection.query(
      sql("SELECT sha256 FROM blobs b WHERE ", kMayDrop, " FOR UPDATE SKIP LOCKED")));
  PgArray list(oid::kBytea);
  for (int i = 0; i < locked.rows(); ++i) list.add(locked.bytes(i, 0));
  auto done = STRATA_TRY(connection.query(
      sql("DELETE FROM blobs b WHERE sha256 = any($1) AND ", kMayDrop), Params().array(list)));
  return done.affected();
}

}  // namespace strata::store
