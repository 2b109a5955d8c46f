#include "store/files/files.h"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>

#include "core/temporary_file.h"
#include "core/text/hex.h"
#include "core/uuid.h"
#include "core/version.h"
#include "store/cluster/schema_readers.h"
#include "store/files/files_mark.h"
#include "store/pg/blobs.h"

namespace strata::store {
namespace {

constexpr const char* kMigration = "000046";  // that added the files outside the database
constexpr int kRowsAtOnce = 500;
constexpr int kUsersShown = 5;
constexpr std::size_t kDamagedShown = 20;
constexpr std::int64_t kMaxInMemory = 64 << 20;  // larger content goes through a temporary file
constexpr std::chrono::hours kSuperfluousAfter{24};
constexpr std::chrono::hours kUploadsEndWithin{24};

// SQL: the content of the blob `b` must be read from its file.
constexpr auto kNeedsFile = sql("b.is_outside AND b.removing IS NULL AND NOT (", kIsUnused, ")");
// SQL: nothing may need the file of a blob any longer, neither an upload that began before the blob
// was marked ($1), nor a backup of the database ($2).
constexpr auto kMayRemove =
    sql("removing <= clock_timestamp() - make_interval(secs => $1) "
        "AND coalesce(unused, removing) <= clock_timestamp() - make_interval(secs => $2)");

tl::unexpected<Error> no_place() {
  return fail(ErrorCode::malformed, "No place for files",
              "Specify the folder or the bucket of the files with --files.", "--files");
}

tl::unexpected<Error> older_node() {
  return fail(ErrorCode::conflict, "Nodes of another version",
              "A node of another version uses this site, and could not read files outside the "
              "database. Update all nodes before you start one with --files.",
              "--files");
}

tl::unexpected<Error> another_site(const std::string& place) {
  return fail(ErrorCode::conflict, "Files of another site",
              place + " contains the files of another site (" + kFilesMark +
                  "). Choose another folder or prefix.",
              "--files");
}

bool is_of_site(const std::string& text, const Uuid& id) {
  const auto mark = parse_files_mark(text);
  return mark && mark->id == id;
}

tl::unexpected<Error> not_moved(const std::vector<Sha256>& damaged) {
  std::string names;
  for (std::size_t i = 0; i < std::min(damaged.size(), kDamagedShown); ++i)
    names += (i == 0 ? "" : ", ") + file_name_of(damaged[i]);
  return fail(ErrorCode::damaged, "Files damaged",
              std::to_string(damaged.size()) + " files are missing or changed: " + names +
                  (damaged.size() > kDamagedShown ? ", …" : "") +
                  ". All others were moved. Copy these files from a backup, or delete what uses "
                  "them (`strata files check`), then repeat the command.");
}

// Creates a file that only this user can read.
Result<void> make_private_file(TemporaryFile& file) {
  std::string path = (std::filesystem::temp_directory_path() / "strata-move-XXXXXX").string();
  const int descriptor = mkstemp(path.data());
  if (descriptor < 0)
    return fail(ErrorCode::storage_full, "No temporary file",
                "Cannot create " + path + ": " + std::strerror(errno) +
                    ". Choose another folder for temporary files with TMPDIR.");
  close(descriptor);
  file.path = path;
  return {};
}

FilesMark read_row(const PgResult& row) { return {row.uuid(0, 0), row.text(0, 1)}; }

}  // namespace

bool Files::is_open() const { return blobs_.files() != nullptr; }

Result<void> Files::open(const FilesPlace& place) {
  auto files = STRATA_TRY(open_file_store(place));
  return open(std::move(files));
}

Result<void> Files::open(std::unique_ptr<FileStore> files) {
  const std::string shown = files->place();
  struct Known {
    Uuid id;
    std::int64_t outside = 0;
  };
  const std::string owner = to_string(random_uuid());
  // The first server creates the row. Other servers then read its id.
  const auto known = STRATA_TRY(pool_.write([&](PgConnection& connection) -> Result<Known> {
    const auto older = STRATA_TRY(exclude_older_programs(connection, kMigration, version(), {}));
    if (older == OlderPrograms::running) return older_node();
    STRATA_TRY(connection.query(sql("INSERT INTO file_store (id, place, owner) VALUES ($1, $2, ",
                                    kDatabaseId, " || '/' || $3) ON CONFLICT DO NOTHING"),
                                Params().uuid(random_uuid()).text(shown).text(owner)));
    const auto row = STRATA_TRY(connection.query(
        sql("SELECT id, (SELECT count(*) FROM blobs b WHERE ", kNeedsFile, ") FROM file_store")));
    return Known{row.uuid(0, 0), row.integer(0, 1)};
  }));
  const auto mark = STRATA_TRY(files->read_mark());
  if (mark && !is_of_site(*mark, known.id)) return another_site(shown);
  if (!mark && known.outside > 0)
    return fail(ErrorCode::conflict, "Files not found",
                shown + " has no " + kFilesMark + ", but " + std::to_string(known.outside) +
                    " files of this site are outside the database. Check that the disk is mounted, "
                    "and that --files names the right place.",
                "--files");
  if (!mark) {
    // No other database uses the new place, so a restored copy owns it, too.
    const auto own = STRATA_TRY(pool_.write([&](PgConnection& connection) -> Result<FilesMark> {
      STRATA_TRY(connection.query(
          sql("UPDATE file_store SET owner = ", kDatabaseId,
              " || '/' || $1 WHERE NOT starts_with(owner, ", kDatabaseId, " || '/')"),
          Params().text(owner)));
      const auto row =
          STRATA_TRY(connection.query("SELECT id, split_part(owner, '/', 3) FROM file_store"));
      return read_row(row);
    }));
    STRATA_TRY(files->write_mark(to_text(own)));
    // Another site may have chosen the same place at the same time.
    const auto written = STRATA_TRY(files->read_mark());
    if (!written || !is_of_site(*written, known.id)) return another_site(shown);
  }
  auto noted = pool_.write([&](PgConnection& connection) {
    return connection.query("UPDATE file_store SET place = $1 WHERE place <> $1",
                            Params().text(shown));
  });
  if (!noted) return tl::unexpected(noted.error());
  blobs_.use(std::move(files));
  return {};
}

Result<void> Files::check_open() {
  if (is_open()) return {};
  const auto known = STRATA_TRY(facts());
  if (known.outside_files == 0) return {};
  return fail(ErrorCode::conflict, "Files not found",
              std::to_string(known.outside_files) +
                  " files of this site are outside the database, in " + known.place +
                  ". Specify their place with --files, or first move them into the database with "
                  "`strata files move --to database`.",
              "--files");
}

Result<bool> Files::owns_files() { return blobs_.owns_files(); }

Result<void> Files::adopt() {
  if (!is_open()) return no_place();
  // Until the mark is written, no database owns the files, and the command can be repeated.
  const auto own = STRATA_TRY(pool_.write([&](PgConnection& connection) -> Result<FilesMark> {
    const auto row = STRATA_TRY(connection.query(sql("UPDATE file_store SET owner = ", kDatabaseId,
                                                     " || '/' || $1 "
                                                     "RETURNING id, split_part(owner, '/', 3)"),
                                                 Params().text(to_string(random_uuid()))));
    return read_row(row);
  }));
  return blobs_.files()->write_mark(to_text(own));
}

Result<FilesFacts> Files::facts() {
  return pool_.read([&](PgConnection& connection) -> Result<FilesFacts> {
    const auto row = STRATA_TRY(
        connection.query(sql("SELECT coalesce((SELECT place FROM file_store), ''), "
                             "count(*) FILTER (WHERE needs_file), "
                             "coalesce(sum(bytes) FILTER (WHERE needs_file), 0)::bigint, "
                             "count(*) FILTER (WHERE NOT is_outside), "
                             "coalesce(sum(bytes) FILTER (WHERE NOT is_outside), 0)::bigint "
                             "FROM (SELECT bytes, is_outside, ",
                             kNeedsFile, " AS needs_file FROM blobs b) b")));
    return FilesFacts{row.text(0, 0), row.integer(0, 1), row.integer(0, 2), row.integer(0, 3),
                      row.integer(0, 4)};
  });
}

void Files::stop_uploads() { blobs_.stop_uploads(); }

FileFaults Files::faults() const {
  const Blobs::Faults& faults = blobs_.faults();
  return {faults.missing, faults.changed, faults.unreachable};
}

Result<bool> Files::sweep(std::chrono::seconds keep, std::chrono::seconds rest,
                          const std::function<bool()>& cancelled) {
  if (!is_open()) return false;
  const bool owns = STRATA_TRY(owns_files());
  if (!owns) return false;
  // `keep` may be shorter than an upload takes.
  STRATA_TRY(
      blobs_.files()->remove_unfinished(std::max<std::chrono::seconds>(keep, kUploadsEndWithin)));
  // Skip rows that others have locked, so that this transaction waits for nobody.
  STRATA_TRY(pool_.write([&](PgConnection& connection) -> Result<void> {
    STRATA_TRY(connection.query(
        sql("UPDATE blobs SET unused = NULL WHERE sha256 IN (SELECT sha256 FROM blobs b "
            "WHERE is_outside AND unused IS NOT NULL AND removing IS NULL AND NOT (",
            kIsUnused, ") FOR NO KEY UPDATE SKIP LOCKED)")));
    STRATA_TRY(connection.query(sql(
        "UPDATE blobs SET unused = clock_timestamp() WHERE sha256 IN (SELECT sha256 FROM blobs b "
        "WHERE is_outside AND unused IS NULL AND removing IS NULL AND ",
        kIsUnused, " FOR NO KEY UPDATE SKIP LOCKED)")));
    return {};
  }));
  const auto marked = STRATA_TRY(pool_.write([&](PgConnection& connection) -> Result<int> {
    // Lock first, because a transaction that is about to use the content has locked its row. The
    // second statement sees what such a transaction has committed.
    const auto old = STRATA_TRY(
        connection.query(sql("SELECT sha256 FROM blobs b WHERE is_outside AND removing IS NULL "
                             "AND unused <= clock_timestamp() - make_interval(secs => $1) AND ",
                             kIsUnused, " ORDER BY sha256 LIMIT $2 FOR UPDATE SKIP LOCKED"),
                         Params().real(double(keep.count())).integer(kRowsAtOnce)));
    PgArray hashes(oid::kBytea);
    for (int i = 0; i < old.rows(); ++i) hashes.add(old.bytes(i, 0));
    STRATA_TRY(connection.query(sql("UPDATE blobs b SET removing = clock_timestamp() "
                                    "WHERE sha256 = any($1) AND ",
                                    kIsUnused),
                                Params().array(hashes)));
    return old.rows();
  }));
  bool more = marked == kRowsAtOnce;
  STRATA_TRY(remove_marked(keep, rest, cancelled, more));
  return more;
}

Result<void> Files::remove_marked(std::chrono::seconds keep, std::chrono::seconds rest,
                                  const std::function<bool()>& cancelled, bool& more) {
  const auto due = STRATA_TRY(pool_.read([&](PgConnection& connection) {
    return connection.query(
        sql("SELECT sha256 FROM blobs WHERE ", kMayRemove, " ORDER BY removing LIMIT $3"),
        Params().real(double(rest.count())).real(double(keep.count())).integer(kRowsAtOnce));
  }));
  // A file that cannot be deleted does not keep the others.
  Result<void> done;
  for (int i = 0; i < due.rows() && !(cancelled && cancelled()); ++i)
    if (auto finished = finish(due.bytes(i, 0), keep, rest); !finished && done)
      done = std::move(finished);
  more = more || due.rows() == kRowsAtOnce;
  return done;
}

// Deletes the file of a row that is marked, or the mark if there is no file. The row stays locked
// during the deletion, so no other server deletes a later file of this hash.
Result<void> Files::finish(Bytes hash, std::chrono::seconds keep, std::chrono::seconds rest) {
  static constexpr auto kDelete = sql("DELETE FROM blobs b WHERE sha256 = $1 AND ", kIsUnused);
  std::optional<Error> refused;
  STRATA_TRY(pool_.write([&](PgConnection& connection) -> Result<void> {
    const auto row = STRATA_TRY(connection.query(
        sql("SELECT is_outside, ", kIsUnused, " FROM blobs b WHERE ", kMayRemove,
            " AND sha256 = $3 FOR UPDATE SKIP LOCKED"),
        Params().real(double(rest.count())).real(double(keep.count())).bytes(hash)));
    if (row.rows() == 0) return {};
    const bool is_outside = row.boolean(0, 0), is_unused = row.boolean(0, 1);
    const char* next = "UPDATE blobs SET removing = NULL, unused = NULL WHERE sha256 = $1";
    if (!is_outside || is_unused) {
      const auto existed = blobs_.files()->remove(sha256_of(hash));
      if (!existed) refused = existed.error();
      // A request that failed may still arrive.
      if (!existed || *existed)
        next = "UPDATE blobs SET removing = clock_timestamp() WHERE sha256 = $1";
      else if (is_unused)
        next = kDelete.c_str();
    }
    STRATA_TRY(connection.query(next, Params().bytes(hash)));
    return {};
  }));
  return refused ? tl::unexpected(*refused) : Result<void>{};
}

Result<void> Files::find_superfluous(const std::function<bool()>& cancelled) {
  if (!is_open()) return {};
  const bool owns = STRATA_TRY(owns_files());
  if (!owns) return {};
  const auto oldest = std::chrono::system_clock::now() - kSuperfluousAfter;
  return each_without_row(cancelled, [&](const std::vector<StoredFile>& batch) {
    return pool_.write([&](PgConnection& connection) -> Result<void> {
      PgArray hashes(oid::kBytea), sizes(oid::kInt8);
      for (const StoredFile& file : batch) {
        if (file.changed > oldest) continue;
        hashes.add(Bytes(file.hash));
        sizes.add(static_cast<std::int64_t>(file.bytes));
      }
      STRATA_TRY(connection.query(
          "INSERT INTO blobs (sha256, bytes, is_outside, chunk_sums, unused) "
          "SELECT sha256, bytes, true, '', clock_timestamp() "
          "FROM unnest($1::bytea[], $2::bigint[]) AS found (sha256, bytes) ORDER BY sha256 "
          "ON CONFLICT (sha256) DO UPDATE "
          "SET unused = clock_timestamp(), removing = clock_timestamp() "
          "WHERE NOT blobs.is_outside AND blobs.removing IS NULL",
          Params().array(hashes).array(sizes)));
      return {};
    });
  });
}

Result<void> Files::each_without_row(
    const std::function<bool()>& cancelled,
    const std::function<Result<void>(const std::vector<StoredFile>&)>& visit) {
  std::vector<StoredFile> batch;
  const auto flush = [&]() -> Result<void> {
    PgArray hashes(oid::kBytea);
    for (const StoredFile& file : batch) hashes.add(Bytes(file.hash));
    const auto known = STRATA_TRY(pool_.read([&](PgConnection& connection) {
      return connection.query(
          "SELECT sha256 FROM blobs WHERE sha256 = any($1) "
          "AND (is_outside OR removing IS NOT NULL)",
          Params().array(hashes));
    }));
    std::set<Sha256> with_row;
    for (int i = 0; i < known.rows(); ++i) with_row.insert(sha256_of(known.bytes(i, 0)));
    std::erase_if(batch, [&](const StoredFile& file) { return with_row.contains(file.hash); });
    if (!batch.empty()) STRATA_TRY(visit(batch));
    batch.clear();
    return {};
  };
  STRATA_TRY(blobs_.files()->list([&](const StoredFile& file) -> Result<void> {
    if (cancelled && cancelled()) return cancelled_problem();
    batch.push_back(file);
    return batch.size() < kRowsAtOnce ? Result<void>{} : flush();
  }));
  return flush();
}

Result<std::vector<Files::Row>> Files::rows_after(Bytes last, bool is_outside) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Row>> {
    const auto found = STRATA_TRY(connection.query(
        sql("SELECT sha256, bytes FROM blobs b WHERE sha256 > $1 AND is_outside = $2 "
            "AND removing IS NULL AND NOT (",
            kIsUnused, ") ORDER BY sha256 LIMIT $3"),
        Params().bytes(last).boolean(is_outside).integer(kRowsAtOnce)));
    std::vector<Row> rows;
    for (int i = 0; i < found.rows(); ++i)
      rows.push_back({sha256_of(found.bytes(i, 0)), found.integer(i, 1)});
    return rows;
  });
}

Result<void> Files::each_row(bool is_outside, Progress& progress, const char* what,
                             const std::function<Result<void>(const Row&)>& visit) {
  const auto known = STRATA_TRY(facts());
  const double all = std::max(1.0, double(is_outside ? known.outside_bytes : known.inside_bytes));
  std::vector<std::uint8_t> last;
  std::int64_t done = 0, files = 0;
  for (;;) {
    const auto rows = STRATA_TRY(rows_after(last, is_outside));
    for (const Row& row : rows) {
      if (progress.cancelled()) return cancelled_problem();
      progress.report(std::min(1.0, double(done) / all),
                      std::string(what) + ", " + std::to_string(files) + " files so far");
      STRATA_TRY(visit(row));
      done += row.bytes;
      ++files;
    }
    if (rows.size() < kRowsAtOnce) return {};
    last.assign(rows.back().hash.begin(), rows.back().hash.end());
  }
}

Result<Files::Moved> Files::move(Direction direction, Progress& progress) {
  if (!is_open()) return no_place();
  const bool into = direction == Direction::into_database;
  const bool may = into || STRATA_TRY(owns_files());
  if (!may)
    return fail(ErrorCode::conflict, "Files of another database",
                "This database is a copy of the one that owns " + blobs_.files()->place() +
                    ", so it cannot move files to it. If it replaces the original, run `strata "
                    "files adopt` first.",
                "--files");
  Moved moved;
  std::vector<Sha256> damaged;
  STRATA_TRY(each_row(into, progress, "Moving", [&](const Row& row) -> Result<void> {
    if (!into && static_cast<std::uint64_t>(row.bytes) > blobs_.files()->max_bytes()) {
      ++moved.skipped;
      return {};
    }
    const auto done = move_one(row, into, progress);
    // One lost file does not stop the move. Users may delete files during the move.
    if (!done && done.error().code == ErrorCode::damaged) {
      damaged.push_back(row.hash);
      return {};
    }
    if (!done && done.error().code != ErrorCode::not_found) return tl::unexpected(done.error());
    if (!done || !*done) {
      ++moved.skipped;
      return {};
    }
    ++moved.files;
    moved.bytes += row.bytes;
    return {};
  }));
  return damaged.empty() ? Result<Moved>(moved) : not_moved(damaged);
}

Result<bool> Files::move_one(const Row& row, bool into, const Progress& progress) {
  const auto cancelled = [&progress] { return progress.cancelled(); };
  std::vector<std::uint8_t> memory;
  std::optional<TemporaryFile> file;
  Content content;
  if (row.bytes <= kMaxInMemory) {
    memory = STRATA_TRY(blobs_.read(row.hash));
    content = content_of(Bytes(memory));
  } else {
    STRATA_TRY(make_private_file(file.emplace()));
    std::ofstream out(file->path, std::ios::binary);
    STRATA_TRY(blobs_.stream(row.hash, 0, static_cast<std::uint64_t>(row.bytes), [&](Bytes piece) {
      out.write(reinterpret_cast<const char*>(piece.data()),
                static_cast<std::streamsize>(piece.size()));
      return bool(out) && !cancelled();
    }));
    if (cancelled()) return cancelled_problem();
    out.close();
    if (!out)
      return fail(ErrorCode::storage_full, "Disk full",
                  "Cannot write " + file->path.string() +
                      ". Choose a larger disk for temporary files with TMPDIR.");
    content = STRATA_TRY(content_of(file->path, cancelled));
  }
  if (content.hash != row.hash || content.bytes != row.bytes)
    return fail(ErrorCode::damaged, "Damaged content",
                "The content " + to_hex(row.hash) +
                    " does not have its hash. Restore it from a backup, then repeat the command.");
  return into ? take_in(content, cancelled) : put_out(content, cancelled);
}

Result<bool> Files::put_out(const Content& content, const std::function<bool()>& cancelled) {
  const auto sums = STRATA_TRY(chunk_sums_of(content, cancelled));
  STRATA_TRY(blobs_.files()->put(content, cancelled));
  return pool_.write_within(kBulkLimits, [&](PgConnection& connection) -> Result<bool> {
    const auto changed =
        STRATA_TRY(connection.query("UPDATE blobs SET is_outside = true, chunk_sums = $2 "
                                    "WHERE sha256 = $1 AND NOT is_outside AND removing IS NULL",
                                    Params().bytes(content.hash).bytes(sums)));
    if (changed.affected() == 0) return false;
    STRATA_TRY(connection.query("DELETE FROM blob_chunks WHERE sha256 = $1",
                                Params().bytes(content.hash)));
    return true;
  });
}

Result<bool> Files::take_in(const Content& content, const std::function<bool()>& cancelled) {
  return pool_.write_within(kBulkLimits, [&](PgConnection& connection) -> Result<bool> {
    const auto changed = STRATA_TRY(connection.query(
        "UPDATE blobs SET is_outside = false, chunk_sums = NULL, unused = clock_timestamp(), "
        "removing = clock_timestamp() WHERE sha256 = $1 AND is_outside AND removing IS NULL",
        Params().bytes(content.hash)));
    if (changed.affected() == 0) return false;
    STRATA_TRY(write_chunks(connection, content, cancelled));
    return true;
  });
}

Result<Files::Checked> Files::check(const std::function<void(const FileProblem&)>& found,
                                    Progress& progress) {
  if (!is_open()) return no_place();
  Checked checked;
  progress.begin_stage(0, 0.95);
  STRATA_TRY(each_row(true, progress, "Checking", [&](const Row& row) -> Result<void> {
    ++checked.files;
    checked.bytes += row.bytes;
    const auto head = blobs_.files()->read(row.hash, 0, 1);
    if (!head && head.error().code != ErrorCode::not_found) return tl::unexpected(head.error());
    const auto whole = head ? blobs_.stream(row.hash, 0, static_cast<std::uint64_t>(row.bytes),
                                            [&](Bytes) { return !progress.cancelled(); })
                            : Result<void>{};
    if (!whole && whole.error().code == ErrorCode::not_found) return {};  // deleted since then
    if (!whole && whole.error().code != ErrorCode::damaged) return tl::unexpected(whole.error());
    if (head && whole) return {};
    const std::string users = STRATA_TRY(users_of(row.hash));
    found({head ? FileProblem::Kind::changed : FileProblem::Kind::missing, file_name_of(row.hash),
           static_cast<std::uint64_t>(row.bytes), users});
    return {};
  }));
  progress.begin_stage(0.95, 1);
  progress.report(0, "Listing the files");
  const auto oldest = std::chrono::system_clock::now() - kSuperfluousAfter;
  const auto cancelled = [&progress] { return progress.cancelled(); };
  STRATA_TRY(each_without_row(cancelled, [&](const std::vector<StoredFile>& files) -> Result<void> {
    for (const StoredFile& file : files)
      if (file.changed <= oldest)
        found({FileProblem::Kind::superfluous, file_name_of(file.hash), file.bytes, {}});
    return {};
  }));
  return checked;
}

Result<std::string> Files::users_of(Bytes hash) {
  return pool_.read([&](PgConnection& connection) -> Result<std::string> {
    const auto row = STRATA_TRY(connection.query(
        "SELECT coalesce(string_agg(what, ', '), '') FROM ("
        "SELECT 'model ' || name AS what FROM all_models WHERE geometry = $1 "
        "OR id IN (SELECT model_id FROM detail_levels WHERE geometry = $1) UNION "
        "SELECT 'source file ' || s.name || ' of model ' || m.name FROM model_sources s "
        "JOIN all_models m ON m.id = s.model_id WHERE s.sha256 = $1 UNION "
        "SELECT 'surface image ' || l.name || ' of model ' || m.name FROM looks l "
        "JOIN all_models m ON m.id = l.model_id WHERE l.picture = $1 UNION "
        "SELECT 'attachment ' || a.id || ' ' || a.name FROM attachments a WHERE a.sha256 = $1 UNION "
        "SELECT 'file ' || f.name || ' of tour ' || t.name FROM tour_files f "
        "JOIN tours t ON t.id = f.tour_id WHERE f.sha256 = $1 UNION "
        "SELECT 'photograph ' || p.name || ' of model ' || m.name FROM photographs p "
        "JOIN all_models m ON m.id = p.model_id WHERE p.sha256 = $1 ORDER BY 1 LIMIT $2) used",
        Params().bytes(hash).integer(kUsersShown)));
    return row.text(0, 0);
  });
}

}  // namespace strata::store
