#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "cli/commands.h"
#include "core/version.h"

int main(int argc, char** argv) {
  CLI::App app{"Strata: GIS layers on the surface of 3D heritage models"};
  app.set_version_flag("--version", "strata " + std::string(strata::version()));
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);

  const std::map<std::string, strata::cli::Command> commands{
      {"serve", strata::cli::add_serve(app)},
      {"import", strata::cli::add_import(app)},
      {"import-deposit", strata::cli::add_import_deposit(app)},
      {"demo", strata::cli::add_demo(app)},
      {"migrate", strata::cli::add_migrate(app)},
      {"doctor", strata::cli::add_doctor(app)},
      {"user", strata::cli::add_user(app)},
      {"token", strata::cli::add_token(app)},
      {"backup", strata::cli::add_backup(app)},
      {"restore", strata::cli::add_restore(app)},
      {"kiosk", strata::cli::add_kiosk(app)},
      {"audit", strata::cli::add_audit(app)},
      {"files", strata::cli::add_files(app)},
      {"journal", strata::cli::add_journal(app)},
      {"upgrade-database", strata::cli::add_upgrade_database(app)},
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : 2;
  }
  return commands.at(app.get_subcommands().front()->get_name())();
}
