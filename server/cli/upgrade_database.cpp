// `strata upgrade-database` changes the private database to a newer major version of PostgreSQL.
#include <iostream>

#include "cli/cancel_by_signal.h"
#include "cli/commands.h"
#include "cli/open_database.h"
#include "cli/progress_line.h"
#include "store/cluster/upgrade.h"

namespace strata::cli {
namespace {

namespace fs = std::filesystem;
using Method = store::UpgradePlan::Method;

struct UpgradeOptions {
  DataOptions data;
  bool apply = false, rehearse = false, dump = false;
};

std::string megabytes(std::uintmax_t bytes) {
  return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MB";
}

std::string version(int major) { return "PostgreSQL " + std::to_string(major); }

const char* way(Method method) {
  switch (method) {
    case Method::clone:
      return "pg_upgrade clones the files: both clusters share the blocks of the disk";
    case Method::copy: return "pg_upgrade copies the files";
    case Method::dump: return "pg_dump writes the data, and pg_restore reads them";
  }
  return "";
}

// Returns a rough estimate. A rehearsal measures the actual time.
const char* expected_time(const store::UpgradePlan& plan) {
  const std::uintmax_t bytes_per_s = plan.method == Method::dump    ? 5'000'000
                                     : plan.method == Method::clone ? 100'000'000
                                                                    : 50'000'000;
  const auto seconds = 15 + plan.bytes / bytes_per_s;
  return seconds <= 60     ? "about a minute"
         : seconds <= 600  ? "minutes"
         : seconds <= 3600 ? "up to an hour"
                           : "hours";
}

void print_plan(const store::UpgradePlan& plan, bool rehearse) {
  const std::string from = version(plan.from), to = version(plan.to);
  std::cout << "database   " << plan.cluster().string() << ", " << megabytes(plan.bytes)
            << (plan.running ? ", a server is running\n" : ", no server is running\n")
            << "from       " << from << " in " << plan.old_programs.string() << "\nto         "
            << to << " in " << plan.new_programs.string() << "\nway        " << way(plan.method)
            << "\ndisk       needs " << megabytes(plan.needed_bytes(rehearse)) << ", "
            << megabytes(plan.free_bytes) << " are free\ntime       " << expected_time(plan)
            << "\n\n1. read every table with " << from << "\n2. make a database of " << to << " in "
            << plan.work().string() << "\n3. transfer the data\n4. start " << to
            << ", compare every table and sequence, and collect statistics\n5. rename "
            << plan.cluster().string() << " to " << plan.fallback.string()
            << ",\n   and the new database to " << plan.cluster().string() << "\n\n";
  if (plan.archived)
    std::cout << "The archive of this database cannot continue with " << to
              << ". After the upgrade, start the server\nwith a new folder of --archive, and keep "
                 "the old archive as long as you may need it.\n\n";
  std::cout << std::flush;
}

void print_report(const store::UpgradeReport& report) {
  std::int64_t rows = 0;
  for (const auto& [name, table] : report.facts.tables) rows += table.rows;
  std::cout << "equal: " << report.facts.tables.size() << " tables with " << rows << " rows, "
            << report.facts.sequences.size() << " sequences, schema " << report.facts.schema_version
            << "\ntime: " << report.took.count() << " s" << std::endl;
}

Result<store::UpgradeReport> work(const store::UpgradePlan& plan, bool rehearse) {
  Progress progress;
  const CancelBySignal signals(progress);
  const ProgressLine line(progress);
  return rehearse ? store::rehearse_upgrade(plan, progress)
                  : store::upgrade_cluster(plan, progress);
}

int upgrade(const UpgradeOptions& options) {
  if (!options.data.database.empty())
    return report({ErrorCode::malformed, "Not a data folder",
                   "This command changes the private database of a data folder. For your own "
                   "PostgreSQL, use its tools. Specify a data folder with --data, without "
                   "--database.",
                   "--database"});
  const auto plan = store::plan_upgrade(options.data.data, options.dump);
  if (!plan) return report(plan.error());
  if (plan->to == plan->from) {
    std::cout << "nothing to do: the database uses " << version(plan->from)
              << ", and no newer version is installed" << std::endl;
    return 0;
  }
  print_plan(*plan, options.rehearse);
  if (!options.apply && !options.rehearse) {
    std::cout << "Nothing was changed. With --rehearse, the command does steps 1 to 4 and deletes "
                 "the result;\na server can keep running. With --apply, it does all steps: stop "
                 "the server first."
              << std::endl;
    return 0;
  }
  const auto done = work(*plan, options.rehearse);
  if (!done) {
    const int code = report(done.error());
    std::cerr << "The site has not changed, and the server can continue with "
              << version(plan->from) << ". The output of the programs is in "
              << (plan->cluster() / "upgrade.log").string() << "." << std::endl;
    return code;
  }
  print_report(*done);
  if (options.rehearse) {
    std::cout << "the rehearsal succeeded; its result is deleted, and nothing was changed"
              << std::endl;
    return 0;
  }
  const fs::path aside = plan->data / ("postgres-" + std::to_string(plan->to));
  std::cout << "the database now uses " << version(plan->to) << "; you can start the server"
            << "\nthe old database is still complete; to go back, stop the server, and run:\n  mv '"
            << plan->cluster().string() << "' '" << aside.string() << "' && mv '"
            << plan->fallback.string() << "' '" << plan->cluster().string()
            << "'\nchanges after the upgrade are then lost; delete " << plan->fallback.string()
            << " when you no longer need it" << std::endl;
  return 0;
}

}  // namespace

Command add_upgrade_database(CLI::App& app) {
  auto* command = app.add_subcommand(
      "upgrade-database",
      "Show how to change the private database to a newer PostgreSQL, rehearse it, or apply it");
  auto options = std::make_shared<UpgradeOptions>();
  add_data_options(*command, options->data);
  auto* rehearse = command->add_flag(
      "--rehearse", options->rehearse,
      "Do everything in a temporary folder of the data folder, and compare the result");
  command->add_flag("--apply", options->apply, "Change the database; no server may be running")
      ->excludes(rehearse);
  command->add_flag("--dump", options->dump,
                    "Use pg_dump and pg_restore, even if pg_upgrade is installed");
  return [options] { return upgrade(*options); };
}

}  // namespace strata::cli
