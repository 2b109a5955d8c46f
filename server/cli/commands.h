#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace strata::cli {

// Each function adds its subcommand; the returned function runs it after parsing and returns the
// exit code: 0 done, 1 failed (reason on stderr). CLI11 reports wrong usage (exit 2 by main).
using Command = std::function<int()>;
Command add_serve(CLI::App& app);
Command add_import(CLI::App& app);
Command add_demo(CLI::App& app);
Command add_migrate(CLI::App& app);
Command add_doctor(CLI::App& app);
Command add_user(CLI::App& app);
Command add_token(CLI::App& app);
Command add_kiosk(CLI::App& app);
Command add_backup(CLI::App& app);
Command add_restore(CLI::App& app);

}  // namespace strata::cli
