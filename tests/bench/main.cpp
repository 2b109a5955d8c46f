#include <map>

#include "bench/bench_commands.h"

int main(int argc, char** argv) {
  CLI::App app{"strata-bench: how fast Strata is, beside the methods it is compared with"};
  app.set_version_flag("--version", "strata-bench " STRATA_VERSION);
  app.require_subcommand(1);
  const std::map<std::string, strata::bench::Command> commands{
      {"atlas", strata::bench::add_atlas(app)},
      {"distance", strata::bench::add_distance(app)},
      {"edit", strata::bench::add_edit(app)},
      {"frames", strata::bench::add_frames(app)},
      {"import", strata::bench::add_import(app)},
      {"memory", strata::bench::add_memory(app)},
      {"nearest", strata::bench::add_nearest(app)},
      {"operators", strata::bench::add_operators(app)},
      {"query", strata::bench::add_query(app)},
      {"sheet", strata::bench::add_sheet(app)},
      {"stream", strata::bench::add_stream(app)},
      {"viewer", strata::bench::add_viewer(app)}};
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return commands.at(app.get_subcommands().front()->get_name())();
}
