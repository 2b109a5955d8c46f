// `strata import-deposit` makes a project of a deposit.
#include <filesystem>
#include <iostream>
#include <optional>

#include "app/deposit/import_deposit.h"
#include "app/deposit/read_bag.h"
#include "cli/cancel_by_signal.h"
#include "cli/commands.h"
#include "cli/open_database.h"
#include "cli/progress_line.h"
#include "store/cluster/scratch_folder.h"

namespace strata::cli {
namespace fs = std::filesystem;
namespace {

struct DepositOptions {
  DataOptions data;
  fs::path deposit;
  std::string slug;
  bool check_only = false;
};

// A bag, which was unpacked into a temporary folder if the deposit is a zip.
struct OpenBag {
  std::optional<store::ScratchFolder> scratch;
  fs::path folder;
};

Result<OpenBag> open_bag(const fs::path& deposit, Progress& progress) {
  std::error_code error;
  OpenBag bag;
  if (fs::is_directory(deposit, error)) {
    bag.folder = deposit;
    return bag;
  }
  if (!fs::is_regular_file(deposit, error))
    return fail(ErrorCode::malformed, "No such file",
                deposit.string() + " does not exist. Specify the zip or the folder of a deposit.");
  auto scratch = STRATA_TRY(store::ScratchFolder::make("deposit"));
  bag.folder = STRATA_TRY(app::unpack_bag(deposit, scratch.folder(), progress));
  bag.scratch.emplace(std::move(scratch));
  return bag;
}

std::string counted(std::int64_t number, const std::string& what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

void print(const app::ImportedDeposit& made) {
  std::cout << "imported the project " << made.project.slug << ": "
            << counted(static_cast<std::int64_t>(made.models.size()), "model") << ", "
            << counted(made.layers, "layer") << ", " << counted(made.tables, "table") << ", "
            << counted(made.records, "record") << ", " << counted(made.photographs, "photograph")
            << ", " << counted(made.files, "file") << std::endl;
  for (const std::string& part : made.left_out) std::cout << "not imported: " << part << std::endl;
}

Result<void> run(const DepositOptions& options) {
  Progress progress;
  // A cancelled import deletes what it has made.
  const CancelBySignal signals(progress);
  const auto bag = [&] {
    const ProgressLine line(progress);
    return open_bag(options.deposit, progress);
  }();
  if (!bag) return tl::unexpected(bag.error());
  if (options.check_only) {
    const auto good = [&] {
      const ProgressLine line(progress);
      return app::check_bag(bag->folder, progress);
    }();
    if (good) std::cout << "the deposit is complete and undamaged" << std::endl;
    return good;
  }
  const auto database = STRATA_TRY(open_database_beside(options.data));
  const auto made = [&] {
    const ProgressLine line(progress);
    return app::import_deposit(*database->store, bag->folder, options.slug, progress);
  }();
  if (!made) return tl::unexpected(made.error());
  print(*made);
  return {};
}

}  // namespace

Command add_import_deposit(CLI::App& app) {
  auto* command = app.add_subcommand(
      "import-deposit", "Make a new project of a deposit; the server can keep running");
  auto options = std::make_shared<DepositOptions>();
  add_data_options(*command, options->data);
  add_files_options(*command, options->data);
  command->add_option("deposit", options->deposit, "Zip of a deposit, or the folder of its bag")
      ->required();
  command->add_option("--slug", options->slug,
                      "Slug of the new project (default: that of the deposit)");
  command->add_flag("--check", options->check_only,
                    "Only check that the deposit is complete and undamaged");
  return [options] {
    const auto done = run(*options);
    return done ? 0 : report(done.error());
  };
}

}  // namespace strata::cli
