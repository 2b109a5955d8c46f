#pragma once

#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/open_database.h"

// Commands with subcommands that use the database, even while a server is using it. `Options`
// must have the member `data` with DataOptions.
namespace strata::cli {

template <class Options>
using Work = std::function<Result<void>(store::Store&, const Options&)>;

template <class Options>
CLI::App* add_subcommand(CLI::App& parent, const std::shared_ptr<Options>& options,
                         const char* name, const char* what) {
  auto* command = parent.add_subcommand(name, what);
  add_data_options(*command, options->data);
  return command;
}

// Runs the chosen subcommand.
template <class Options>
Command choosing(CLI::App* parent, std::shared_ptr<Options> options,
                 std::map<std::string, Work<Options>> works) {
  parent->require_subcommand(1);
  return [parent, options = std::move(options), works = std::move(works)] {
    auto database = open_database_beside(options->data);
    if (!database) return report(database.error());
    const auto done =
        works.at(parent->get_subcommands().front()->get_name())(*(*database)->store, *options);
    return done ? 0 : report(done.error());
  };
}

inline std::string day_of(const std::optional<std::chrono::system_clock::time_point>& time) {
  if (!time) return "never";
  const std::time_t seconds = std::chrono::system_clock::to_time_t(*time);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[20];
  std::strftime(text, sizeof text, "%Y-%m-%d", &utc);
  return text;
}

}  // namespace strata::cli
