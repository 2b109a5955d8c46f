#include <iostream>

#include "cli/commands.h"
#include "cli/install_dirs.h"
#include "cli/open_database.h"
#include "store/cluster/inspect.h"

namespace strata::cli {

Command add_migrate(CLI::App& app) {
  auto* command = app.add_subcommand("migrate", "Update the database schema to this version");
  auto options = std::make_shared<DataOptions>();
  add_data_options(*command, *options);
  return [options] {
    auto database = open_database(*options);  // migrates the database
    if (!database) return report(database.error());
    auto info = (*database)->store->info();
    if (!info) return report(info.error());
    const auto known = store::newest_migration(install_dirs().migrations);
    if (!known) return report(known.error());
    std::cout << "schema " << info->schema_version << ", PostgreSQL " << info->server_version
              << "\n";
    if (info->schema_version > *known)
      std::cout << "The database is newer than this program, which has schema " << *known
                << " and can use the database.\n";
    if (info->readable_from < info->schema_version)
      std::cout << "Programs with schema " << info->readable_from
                << " or later can use the database.\n";
    std::cout << std::flush;
    return 0;
  };
}

}  // namespace strata::cli
