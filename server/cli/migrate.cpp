#include <iostream>

#include "cli/commands.h"
#include "cli/open_database.h"

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
    std::cout << "schema " << info->schema_version << ", PostgreSQL " << info->server_version
              << std::endl;
    return 0;
  };
}

}  // namespace strata::cli
