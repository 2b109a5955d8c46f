// `strata files` manages the content outside the database. It runs on the server's machine, even
// while the server is running.
#include <iostream>

#include "cli/progress_line.h"
#include "cli/subcommands.h"
#include "store/files/files.h"

namespace strata::cli {
namespace {

struct FileOptions {
  DataOptions data;
  std::string to = "files";
};

std::string megabytes(std::int64_t bytes) {
  return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MB";
}

std::string counted(std::int64_t files) {
  return std::to_string(files) + (files == 1 ? " file" : " files");
}

Result<void> print_facts(store::Store& store, const FileOptions&) {
  const auto facts = STRATA_TRY(store.files().facts());
  std::cout << "in the database: " << counted(facts.inside_files) << ", "
            << megabytes(facts.inside_bytes) << "\noutside: " << counted(facts.outside_files)
            << ", " << megabytes(facts.outside_bytes);
  if (!facts.place.empty()) std::cout << ", in " << facts.place;
  std::cout << std::endl;
  return {};
}

Result<void> move_files(store::Store& store, const FileOptions& options) {
  using Direction = store::Files::Direction;
  const bool into = options.to == "database";
  Progress progress;
  const auto moved = [&] {
    const ProgressLine line(progress);
    return store.files().move(into ? Direction::into_database : Direction::out_of_database,
                              progress);
  }();
  if (!moved) return tl::unexpected(moved.error());
  std::cout << "moved " << counted(moved->files) << ", " << megabytes(moved->bytes) << std::endl;
  if (moved->skipped > 0)
    std::cout << "left " << counted(moved->skipped)
              << " where they are: too large for the bucket, or being deleted" << std::endl;
  return {};
}

const char* name_of(store::FileProblem::Kind kind) {
  switch (kind) {
    case store::FileProblem::Kind::missing: return "missing";
    case store::FileProblem::Kind::changed: return "changed";
    case store::FileProblem::Kind::superfluous: break;
  }
  return "superfluous";
}

Result<void> check_files(store::Store& store, const FileOptions&) {
  std::vector<store::FileProblem> problems;
  Progress progress;
  const auto checked = [&] {
    const ProgressLine line(progress);
    return store.files().check(
        [&](const store::FileProblem& problem) { problems.push_back(problem); }, progress);
  }();
  if (!checked) return tl::unexpected(checked.error());
  std::int64_t lost = 0, superfluous = 0;
  for (const store::FileProblem& problem : problems) {
    ++(problem.kind == store::FileProblem::Kind::superfluous ? superfluous : lost);
    std::cout << name_of(problem.kind) << " " << problem.name << " " << problem.bytes << " bytes"
              << (problem.used_by.empty() ? "" : " used by " + problem.used_by) << "\n";
  }
  std::cout << "checked " << counted(checked->files) << ", " << megabytes(checked->bytes) << ": "
            << lost << " missing or changed, " << superfluous << " superfluous" << std::endl;
  if (lost == 0) return {};
  return fail(ErrorCode::damaged, "Files damaged",
              counted(lost) + " of the site are missing or changed. Copy them from a backup.");
}

Result<void> adopt_files(store::Store& store, const FileOptions&) {
  STRATA_TRY(store.files().adopt());
  std::cout << "this database owns the files now: the server stores new ones outside the database, "
               "and deletes unused ones"
            << std::endl;
  return {};
}

}  // namespace

Command add_files(CLI::App& app) {
  auto* parent = app.add_subcommand("files", "Manage the files outside the database");
  auto options = std::make_shared<FileOptions>();
  std::map<std::string, Work<FileOptions>> works;
  const auto add = [&](const char* name, const char* what, Work<FileOptions> work) {
    auto* command = add_subcommand(*parent, options, name, what);
    add_files_options(*command, options->data);
    works[name] = std::move(work);
    return command;
  };
  add("show", "Print how many files are in the database and outside", print_facts);
  add("check", "Read all files outside, and list missing, changed and superfluous files",
      check_files);
  add("move", "Move all files out of the database, or back into it", move_files)
      ->add_option("--to", options->to, "files or database")
      ->check(CLI::IsMember({"files", "database"}))
      ->capture_default_str();
  add("adopt",
      "Let a restored copy of the database, instead of the original, write and delete files",
      adopt_files);
  return choosing<FileOptions>(parent, options, std::move(works));
}

}  // namespace strata::cli
