// `strata restore --archive` restores the site as it was at a moment, from a server's archive.
#include "cli/restore.h"

#include <iostream>

#include "cli/open_database.h"
#include "cli/progress_line.h"
#include "core/text/timestamp.h"
#include "store/cluster/archive_restore.h"
#include "store/cluster/scratch_folder.h"

namespace strata::cli {
namespace fs = std::filesystem;
namespace {

using Time = std::chrono::system_clock::time_point;

Result<std::optional<Time>> parse_moment(const std::string& text) {
  if (text.empty()) return std::optional<Time>();
  if (const auto moment = parse_time(text, UnzonedTime::local)) return moment;
  return fail(ErrorCode::malformed, "Invalid moment",
              "Enter a date and a time, for example 2026-11-21T14:32 (in the time zone of this "
              "machine), 2026-11-21T14:32:00Z or 2026-11-21T14:32:00+01:00.",
              "--at");
}

std::string counted(std::int64_t number, const std::string& what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

void print_site(const store::RestoredSite& site) {
  std::cout << "the last change is from " << utc_text(site.reached) << "\n"
            << counted(site.projects, "project") << ", " << counted(site.models, "model") << ", "
            << counted(site.edits, "edit");
  if (site.last_edit) std::cout << ", the last edit from " << utc_text(*site.last_edit);
  std::cout << std::endl;
}

Result<store::RestoredSite> recover(const store::ArchiveFolder& archive,
                                    const store::RestorePlan& plan, const fs::path& folder) {
  Progress progress;
  const ProgressLine line(progress);
  return store::restore_archive(archive, plan, folder, progress);
}

Result<store::ScratchFolder> restore_folder(const ArchiveRestore& options, const fs::path& data) {
  if (options.check_only) return store::ScratchFolder::make("restore", 0755);
  return store::ScratchFolder(data / kRestoring);
}

Result<void> restore_or_check(const ArchiveRestore& options) {
  const fs::path data = fs::absolute(options.data);
  if (!options.check_only) STRATA_TRY(check_new_data_folder(data));
  const auto archive = STRATA_TRY(store::ArchiveFolder::open(options.archive));
  const auto moment = STRATA_TRY(parse_moment(options.at));
  const auto plan = STRATA_TRY(store::plan_restore(archive, moment));
  std::error_code ignored;
  if (!options.check_only) fs::remove_all(data / kRestoring, ignored);
  const auto scratch = STRATA_TRY(restore_folder(options, data));
  std::cout << "restoring " << (moment ? "the state at " + utc_text(*moment) : "the newest state")
            << "\nfrom the copy of " << utc_text(plan.copy.made)
            << " and the changes since then\nto "
            << (options.check_only ? "the temporary folder " + scratch.folder().string()
                                   : data.string())
            << std::endl;
  const auto site = STRATA_TRY(recover(archive, plan, scratch.folder()));
  if (!options.check_only) STRATA_TRY(finish_restore(data));
  print_site(site);
  std::cout << (options.check_only ? "the archive is good; the temporary folder is deleted"
                                   : "you can start the server with this data and a new archive")
            << std::endl;
  return {};
}

}  // namespace

Result<void> check_new_data_folder(const fs::path& data) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(data, error))
    if (entry.path().filename() != kRestoring)
      return fail(ErrorCode::conflict, "Data folder not empty",
                  data.string() +
                      " already contains a site or other files. Specify a new folder with --data.",
                  "--data");
  return {};
}

Result<void> finish_restore(const fs::path& data) {
  const fs::path place = data / "postgres";
  std::error_code error;
  fs::rename(data / kRestoring / "postgres", place, error);
  if (error)
    return fail(
        ErrorCode::internal, "Backup not restored",
        "Cannot rename the restored folder to " + place.string() + ": " + error.message() + ".");
  return {};
}

int restore_from_archive(const ArchiveRestore& options) {
  const auto done = restore_or_check(options);
  return done ? 0 : report(done.error());
}

}  // namespace strata::cli
