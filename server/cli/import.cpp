#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/open_database.h"
#include "cli/progress_line.h"
#include "cli/remote_import.h"
#include "jobs/import_job.h"

namespace strata::cli {
namespace {

struct ImportOptions {
  DataOptions data;
  std::vector<std::string> files;
  std::string server, token, unit;
  jobs::ImportRequest request;
};

Result<std::string> import_locally(store::Store& store, const jobs::ImportRequest& request, Progress& progress) {
  auto model = jobs::import_model(store, request, progress);
  if (!model) return tl::unexpected(model.error());
  auto project = store.project(std::to_string(model->project_id));
  if (!project) return tl::unexpected(project.error());
  return to_json(*model, project->slug).dump(2);
}

int run(const ImportOptions& options) {
  std::unique_ptr<OpenDatabase> database;
  if (options.server.empty()) {
    auto opened = open_database(options.data);
    if (!opened) return report(opened.error());
    database = std::move(*opened);
  }
  for (const auto& file : options.files) {
    jobs::ImportRequest request = options.request;
    request.files = {{std::filesystem::path(file).filename().string(), file}};
    if (!options.unit.empty()) request.unit = parse_unit(options.unit);
    if (!std::filesystem::is_regular_file(file)) return report({400, "No such file", file, {}});
    if (auto good = jobs::check(request); !good) return report(good.error());
    Progress progress;
    auto model = [&] {
      ProgressLine line(progress);
      return database ? import_locally(*database->store, request, progress)
                      : import_remotely(options.server, options.token, request, progress);
    }();
    if (!model) {
      std::cerr << file << ": ";
      return report(model.error());
    }
    std::cout << *model << std::endl;
  }
  return 0;
}

}  // namespace

Command add_import(CLI::App& app) {
  auto* command = app.add_subcommand("import", "Bring scans in: PLY or OBJ; the model as JSON on stdout");
  auto options = std::make_shared<ImportOptions>();
  add_data_options(*command, options->data);
  command->add_option("files", options->files, "PLY or OBJ files")->required();
  command->add_option("--name", options->request.name, "Name of the model (default: the file's name)");
  command->add_option("--project", options->request.project, "Project it belongs to")->capture_default_str();
  command->add_option("--unit", options->unit, "Unit of the coordinates")->check(CLI::IsMember({"mm", "cm", "m"}));
  command->add_option("--up", options->request.up, "Axis that points up")->check(CLI::IsMember({"x", "y", "z"}));
  command->add_option("--crs", options->request.crs, "Coordinate system, EPSG:n");
  command->add_option("--resolution", options->request.resolution, "Default resolution of new layers")
      ->check(CLI::IsMember({2048, 4096, 8192, 16384}));
  command->add_flag("--strict", options->request.strict, "Refuse a file that needs repair");
  command->add_option("--server", options->server, "A running server: http://host:port")->envname("STRATA_SERVER");
  command->add_option("--token", options->token, "Token for --server")->envname("STRATA_OWNER_TOKEN");
  return [options] { return run(*options); };
}

}  // namespace strata::cli
