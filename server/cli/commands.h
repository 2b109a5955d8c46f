#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace strata::cli {

// Each function adds its subcommand. The returned function runs the subcommand after parsing. It
// returns the exit code, which is 0 on success and 1 on failure, with the reason on stderr. CLI11
// reports wrong usage, and main then exits with 2.
using Command = std::function<int()>;
Command add_serve(CLI::App& app);
Command add_import(CLI::App& app);
Command add_import_deposit(CLI::App& app);
Command add_demo(CLI::App& app);
Command add_migrate(CLI::App& app);
Command add_doctor(CLI::App& app);
Command add_user(CLI::App& app);
Command add_token(CLI::App& app);
Command add_kiosk(CLI::App& app);
Command add_audit(CLI::App& app);
Command add_files(CLI::App& app);
Command add_journal(CLI::App& app);
Command add_backup(CLI::App& app);
Command add_restore(CLI::App& app);
Command add_upgrade_database(CLI::App& app);

}  // namespace strata::cli
