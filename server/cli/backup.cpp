// `strata backup` and `strata restore` copy a whole site to a folder and back.
#include <iostream>

#include "cli/commands.h"
#include "cli/install_dirs.h"
#include "cli/open_database.h"
#include "cli/progress_line.h"
#include "cli/restore.h"
#include "store/cluster/backup.h"
#include "store/cluster/inspect.h"
#include "store/cluster/scratch_folder.h"

namespace strata::cli {
namespace {

namespace fs = std::filesystem;

struct BackupOptions {
  DataOptions data;
  fs::path folder;
  bool check_only = false;
  fs::path archive;  // restore from this archive instead of `folder`
  std::string at;
};

std::string summary(const store::BackupFacts& facts) {
  // `before` is the name of the table in older backups.
  const auto count = [&](const char* table, const char* what, const char* before = "") {
    const auto rows = facts.rows_of(table) + facts.rows_of(before);
    return std::to_string(rows) + " " + what + (rows == 1 ? "" : "s");
  };
  return count("public.all_models", "model", "public.models") + ", " +
         count("public.all_layers", "layer", "public.layers") + ", " +
         count("public.edits", "edit") + ", " + count("public.attachments", "file") + "; " +
         std::to_string((facts.bytes + (1u << 20) - 1) >> 20) + " MB, schema " +
         std::to_string(facts.schema_version) + ", of " + facts.made;
}

// Prints what else a restore needs, if some content is outside the database.
void print_files(const store::BackupFacts& facts) {
  if (facts.files.count == 0) return;
  std::cout << "NOT in the backup: " << facts.files.count << " files, "
            << ((facts.files.bytes + (1 << 20) - 1) >> 20) << " MB, outside the database in "
            << facts.files.place
            << "\nCopy them, too (docs/how-to/keep-files-outside-the-database.md)" << std::endl;
}

// Finds the database without changing it, because a server of this or another version may be using
// it.
struct Source {
  std::unique_ptr<store::Cluster> cluster;
  std::string dsn;
};
Result<Source> find_source(const DataOptions& options) {
  if (!options.database.empty()) return Source{nullptr, options.database};
  const auto state = store::Cluster::inspect(options.data);
  if (state.running) return Source{nullptr, state.dsn};
  if (state.version == 0)
    return fail(ErrorCode::not_found, "No database",
                "There is no database in " + fs::absolute(options.data).string() +
                    ". Specify the server's folder with --data, or its database with --database.");
  auto cluster = STRATA_TRY(store::Cluster::start(fs::absolute(options.data)));
  std::string dsn = cluster->dsn();
  return Source{std::move(cluster), std::move(dsn)};
}

int backup(const BackupOptions& options) {
  auto source = find_source(options.data);
  if (!source) return report(source.error());
  Progress progress;
  const auto facts = [&] {
    const ProgressLine line(progress);
    return store::write_backup(source->dsn, options.folder, progress);
  }();
  if (!facts) return report(facts.error());
  std::cout << "backed up " << summary(*facts) << "\nin " << fs::absolute(options.folder).string()
            << std::endl;
  print_files(*facts);
  return 0;
}

// Restores to a temporary folder first. An interrupted restore then leaves no incomplete database
// that a server could start with.
Result<void> restore_into_folder(const BackupOptions& options, const store::BackupFacts& facts,
                                 Progress& progress) {
  const fs::path data = fs::absolute(options.data.data), place = data / "postgres",
                 beside = data / kRestoring;
  std::error_code error;
  if (fs::exists(place, error))
    return fail(ErrorCode::conflict, "Data folder not empty",
                data.string() + " already contains a site. Specify a new folder with --data.",
                "--data");
  fs::remove_all(beside, error);  // left by an interrupted restore
  auto restored = [&]() -> Result<void> {
    auto cluster = STRATA_TRY(store::Cluster::start(beside));
    return store::restore_backup(options.folder, facts, cluster->dsn(), progress);
  }();
  if (restored) STRATA_TRY(finish_restore(data));
  std::error_code ignored;
  fs::remove_all(beside, ignored);
  return restored;
}

// Restores into a private cluster in a temporary folder, and compares every table with the backup.
Result<void> restore_to_check(const fs::path& folder, const store::BackupFacts& facts,
                              Progress& progress) {
  const auto scratch = STRATA_TRY(store::ScratchFolder::make("restore", 0755));
  store::ClusterOptions cluster_options;
  cluster_options.settings = {"fsync=off"};  // the folder is deleted at the end
  const auto cluster = STRATA_TRY(store::Cluster::start(scratch.folder(), cluster_options));
  return store::restore_backup(folder, facts, cluster->dsn(), progress);
}

int restore(const BackupOptions& options) {
  if (!options.archive.empty()) {
    if (!options.data.database.empty())
      return report({ErrorCode::malformed, "Not a data folder",
                     "An archive can be restored only into a new data folder. Specify it with "
                     "--data, without --database.",
                     "--database"});
    return restore_from_archive(
        {options.archive, options.data.data, options.at, options.check_only});
  }
  Progress progress;
  const auto facts = [&] {
    const ProgressLine line(progress);
    return store::check_backup(options.folder, progress);
  }();
  if (!facts) return report(facts.error());
  const auto known = store::newest_migration(install_dirs().migrations);
  if (!known) return report(known.error());
  if (facts->schema_version > *known)
    return report({ErrorCode::conflict,
                   "Newer backup",
                   "The backup has schema " + std::to_string(facts->schema_version) +
                       ", but this program only supports schemas up to " + std::to_string(*known) +
                       ". Restore it with the version that wrote it, or with a later one.",
                   {}});
  const auto done = [&]() -> Result<void> {
    const ProgressLine line(progress);
    if (options.check_only) return restore_to_check(options.folder, *facts, progress);
    if (options.data.database.empty()) return restore_into_folder(options, *facts, progress);
    return store::restore_backup(options.folder, *facts, options.data.database, progress);
  }();
  if (!done) return report(done.error());
  if (options.check_only) {
    std::cout << "the backup is good: " << summary(*facts) << std::endl;
    print_files(*facts);
    return 0;
  }
  std::cout << "restored " << summary(*facts)
            << "\nevery table equals the backup; you can start the server with this data"
            << std::endl;
  if (facts->files.count > 0)
    std::cout << facts->files.count << " files are outside the database: start the server with "
              << "--files, and run `strata files check`. They were in " << facts->files.place
              << std::endl;
  return 0;
}

}  // namespace

Command add_backup(CLI::App& app) {
  auto* command = app.add_subcommand(
      "backup", "Back up the whole site into a folder; the server can keep running");
  auto options = std::make_shared<BackupOptions>();
  add_data_options(*command, options->data);
  command
      ->add_option("folder", options->folder,
                   "New folder for the backup, for example /backups/2026-11-21")
      ->required();
  return [options] { return backup(*options); };
}

Command add_restore(CLI::App& app) {
  auto* command =
      app.add_subcommand("restore", "Restore a backup into a new data folder or an empty database");
  auto options = std::make_shared<BackupOptions>();
  add_data_options(*command, options->data);
  auto* folder =
      command->add_option("folder", options->folder, "Folder of a backup made by `strata backup`");
  auto* archive = command
                      ->add_option("--archive", options->archive,
                                   "Restore from the archive of `strata serve --archive`")
                      ->excludes(folder);
  command
      ->add_option("--at", options->at,
                   "With --archive: the moment to restore, for example 2026-11-21T14:32 or "
                   "2026-11-21T14:32:00Z (default: the newest state)")
      ->needs(archive);
  command->add_flag("--check", options->check_only,
                    "Only check the backup or the archive: restore it into a temporary folder "
                    "(TMPDIR), compare it, and delete the folder");
  command->callback([folder, archive] {
    if (folder->empty() && archive->empty()) throw CLI::RequiredError("folder or --archive");
  });
  return [options] { return restore(*options); };
}

}  // namespace strata::cli
