#include "store/cluster/archive_copies.h"

#include <algorithm>

#include "core/log.h"
#include "store/cluster/cluster.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace fs = std::filesystem;
namespace {

constexpr const char* kReady = ".ready";

// Deletes a folder of the archive. Renames it first, so that an interruption does not leave an
// incomplete copy that looks complete. Returns false if the folder still looks like a complete
// copy.
bool delete_copy(const fs::path& folder) {
  std::error_code error;
  fs::path part = folder;
  if (folder.extension() != kUnfinished) {
    part += kUnfinished;
    fs::rename(folder, part, error);
    if (error) {
      log::warning("archive: cannot delete " + folder.string() + ": " + error.message() + ".");
      return false;
    }
  }
  fs::remove_all(part, error);
  if (error)
    log::warning("archive: cannot delete " + part.string() + ": " + error.message() +
                 ". Delete it yourself.");
  return true;
}

// Returns the segments that PostgreSQL still has to archive.
std::set<WalSegment> waiting_segments(const Cluster& cluster) {
  std::set<WalSegment> found;
  std::error_code error;
  for (const auto& entry :
       fs::directory_iterator(cluster.folder() / "pgdata/pg_wal/archive_status", error)) {
    const fs::path name = entry.path().filename();
    if (name.extension() != kReady) continue;
    if (const auto segment = parse_wal_name(name.stem().string())) found.insert(*segment);
  }
  return found;
}

}  // namespace

Result<ArchiveFolder::Copy> make_copy(const ArchiveFolder& archive, const Cluster& cluster,
                                      const std::function<bool()>& goes_on) {
  const auto user = STRATA_TRY(database_user());
  const auto programs = STRATA_TRY(find_programs(data_version(cluster.folder() / "pgdata")));
  const fs::path log = cluster.folder() / "archive.log";
  std::error_code error;
  fs::remove(log, error);
  // The processes of an interrupted copy may still write to its folder for a moment, so each
  // attempt uses a new name.
  const fs::path part =
      archive.copies_folder() / (copy_name(std::chrono::system_clock::now()) + kUnfinished);
  auto copied = run_to_end({programs / "pg_basebackup", "--dbname=" + cluster.dsn("postgres"),
                            "--pgdata=" + part.string(), "--format=plain", "--wal-method=stream",
                            "--checkpoint=fast", "--label=strata", "--no-password"},
                           user, log, goes_on);
  // Rounded up, because the recovery cannot end before the copy.
  const auto made = std::chrono::ceil<std::chrono::milliseconds>(std::chrono::system_clock::now());
  if (copied)
    copied =
        run_to_end({programs / "pg_verifybackup", "--quiet", part.string()}, user, log, goes_on);
  const fs::path whole = archive.copies_folder() / copy_name(made);
  if (copied) {
    fs::rename(part, whole, error);
    if (error)
      copied = fail(ErrorCode::internal, "Copy not completed",
                    "Cannot rename " + part.string() + ": " + error.message() + ".");
  }
  if (!copied) {
    delete_copy(part);
    return tl::unexpected(copied.error());
  }
  sync_folder(archive.copies_folder());
  const auto copies = archive.copies();
  for (const auto& copy : copies)
    if (copy.folder == whole) return copy;
  return fail(ErrorCode::internal, "Copy not completed",
              "Cannot read the file backup_label of " + whole.string() + ".");
}

Result<bool> needs_copy(const ArchiveFolder& archive, const Cluster& cluster,
                        std::chrono::hours every) {
  const auto copies = archive.copies();
  if (copies.empty()) return true;
  const auto age = std::chrono::system_clock::now() - copies.back().made;
  if (age >= every || age < age.zero()) return true;  // the clock was wrong if a copy is too new
  auto connection = STRATA_TRY(PgConnection::connect(cluster.dsn("postgres")));
  auto row = STRATA_TRY(connection.query("SELECT pg_walfile_name(pg_current_wal_lsn())"));
  const auto current = parse_wal_name(row.text(0, 0));
  if (!current || current->timeline != copies.back().first.timeline) return true;
  // Read the waiting segments first, because PostgreSQL may archive them at any time.
  std::set<WalSegment> there = waiting_segments(cluster);
  there.merge(archive.segments());
  return first_missing(there, copies.back().first, *current).has_value();
}

void drop_unfinished(const ArchiveFolder& archive) {
  std::error_code error;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(archive.copies_folder(), error))
    if (entry.path().extension() == kUnfinished) found.push_back(entry.path());
  for (const auto& folder : found) {
    log::info("archive: deleting the interrupted copy " + folder.filename().string());
    delete_copy(folder);
  }
}

void drop_old(const ArchiveFolder& archive, int keep) {
  auto copies = archive.copies();
  while (copies.size() > static_cast<std::size_t>(std::max(1, keep))) {
    if (!delete_copy(copies.front().folder)) break;  // its WAL stays, too
    copies.erase(copies.begin());
  }
  if (copies.empty()) return;
  std::error_code error;
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(archive.wal(), error))
    if (wal_can_go(entry.path().filename().string(), copies.front().first))
      old.push_back(entry.path());
  for (const auto& file : old) fs::remove(file, error);
}

}  // namespace strata::store
