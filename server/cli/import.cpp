#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/commands.h"
#include "cli/open_database.h"
#include "cli/progress_line.h"
#include "cli/remote_import.h"
#include "jobs/companions.h"
#include "jobs/import_job.h"
#include "mesh/io/unpack.h"
#include "store/content/projects.h"

namespace strata::cli {
namespace {

struct ImportOptions {
  DataOptions data;
  std::vector<std::string> files;
  std::string server, token, unit;
  jobs::ImportRequest request;
};

Result<std::string> import_locally(store::Store& store, const jobs::ImportRequest& request,
                                   Progress& progress) {
  auto model = STRATA_TRY(jobs::import_model(store, request, progress));
  auto project = STRATA_TRY(store.projects().find(to_string(model.project_id)));
  return to_json(model, project.slug).dump(2);
}

// Returns one list of files per model. A list contains the mesh and the files to which it refers.
// If the command names only one mesh or archive, all other files belong to it.
Result<std::vector<std::vector<jobs::ImportFile>>> group_scans(
    const std::vector<std::string>& paths) {
  std::vector<std::vector<jobs::ImportFile>> scans;
  std::vector<std::filesystem::path> others;
  for (const std::filesystem::path path : paths) {
    if (!std::filesystem::is_regular_file(path))
      return fail(ErrorCode::malformed, "No such file", path.string());
    if (mesh::input_kind(path.filename().string()) == mesh::InputKind::companion &&
        paths.size() > 1)
      others.push_back(path);
    else
      scans.push_back(jobs::with_companions(path));
  }
  for (const auto& path : others) {
    const auto has = [&](const auto& files) {
      return std::ranges::any_of(files, [&](const auto& file) {
        std::error_code error;
        return std::filesystem::equivalent(file.path, path, error);
      });
    };
    if (std::ranges::any_of(scans, has)) continue;
    if (scans.size() != 1)
      return fail(
          ErrorCode::malformed, "File without a scan",
          path.string() +
              " does not belong to any of the scans. Import the scan that uses it in a separate "
              "command.");
    scans[0].push_back({path.filename().string(), path});
  }
  return scans;
}

// Names the files by their paths from the innermost folder that contains all of them, with that
// folder. The server stores the names, and outer folders are private.
void name_from_common_folder(std::vector<jobs::ImportFile>& files) {
  namespace fs = std::filesystem;
  const auto absolute = [](const jobs::ImportFile& file) {
    return fs::absolute(file.path).lexically_normal();
  };
  const auto contains = [](const fs::path& folder, const fs::path& file) {
    return std::ranges::mismatch(folder, file).in1 == folder.end();
  };
  if (files.empty()) return;
  fs::path common = absolute(files.front()).parent_path();
  for (const auto& file : files)
    while (!contains(common, absolute(file))) common = common.parent_path();
  for (auto& file : files)
    file.filename = absolute(file).lexically_relative(common.parent_path()).generic_string();
}

// Adds the scans in a folder and in its folders, with the files that they use.
Result<void> add_folder(const std::filesystem::path& folder,
                        std::vector<std::filesystem::path>& paths) {
  std::error_code error;
  std::vector<std::filesystem::path> found;
  auto entry = std::filesystem::recursive_directory_iterator(folder, error);
  for (; !error && entry != std::filesystem::recursive_directory_iterator(); entry.increment(error))
    if (entry->is_regular_file(error) && mesh::is_scan_file(entry->path().filename().string()))
      found.push_back(entry->path());
  if (error)
    return fail(ErrorCode::malformed, "Folder cannot be read",
                folder.string() + ": " + error.message());
  std::ranges::sort(found);
  paths.insert(paths.end(), found.begin(), found.end());
  return {};
}

// Returns the files of one model with parts: first the scans, then the files that they use. A
// named folder means all such files in it.
Result<std::vector<std::vector<jobs::ImportFile>>> all_scans(
    const std::vector<std::string>& named) {
  namespace fs = std::filesystem;
  const auto is_scan = [](const fs::path& path) {
    return mesh::is_mesh(mesh::input_kind(path.filename().string()));
  };
  std::vector<fs::path> paths;
  for (const fs::path path : named) {
    std::error_code unknown;
    if (fs::is_directory(path, unknown)) {
      STRATA_TRY(add_folder(path, paths));
    } else if (!fs::is_regular_file(path, unknown)) {
      return fail(ErrorCode::malformed, "No such file", path.string());
    } else if (is_scan(path)) {
      for (const auto& file : jobs::with_companions(path)) paths.push_back(file.path);
    } else {
      paths.push_back(path);
    }
  }
  std::ranges::stable_partition(paths, is_scan);
  std::vector<jobs::ImportFile> files;
  std::set<fs::path> taken;
  for (const fs::path& path : paths)
    if (taken.insert(fs::absolute(path).lexically_normal()).second) files.push_back({"", path});
  name_from_common_folder(files);
  return std::vector<std::vector<jobs::ImportFile>>{std::move(files)};
}

int run(const ImportOptions& options) {
  std::unique_ptr<OpenDatabase> database;
  if (options.server.empty()) {
    auto opened = open_database(options.data);
    if (!opened) return report(opened.error());
    database = std::move(*opened);
  }
  auto scans = options.request.parts ? all_scans(options.files) : group_scans(options.files);
  if (!scans) return report(scans.error());
  for (const auto& files : *scans) {
    jobs::ImportRequest request = options.request;
    request.files = files;
    if (!options.unit.empty()) request.unit = parse_unit(options.unit);
    if (auto good = jobs::check(request); !good) return report(good.error());
    Progress progress;
    auto model = [&] {
      ProgressLine line(progress);
      return database ? import_locally(*database->store, request, progress)
                      : import_remotely(options.server, options.token, request, progress);
    }();
    if (!model) {
      std::cerr << files[0].path.string() << ": ";
      return report(model.error());
    }
    std::cout << *model << std::endl;
  }
  return 0;
}

}  // namespace

Command add_import(CLI::App& app) {
  auto* command = app.add_subcommand("import", "Import scans, and print the models as JSON");
  auto options = std::make_shared<ImportOptions>();
  add_data_options(*command, options->data);
  add_files_options(*command, options->data);
  command
      ->add_option(
          "files", options->files,
          "Scans: PLY, OBJ, STL, glTF, GLB, LAS or zip, and the material and picture files that they use")
      ->required();
  command->add_option("--name", options->request.name,
                      "Name of the model (default: the file's name)");
  command->add_option("--project", options->request.project, "Project of the model")
      ->capture_default_str();
  command->add_option("--unit", options->unit, "Unit of the coordinates")
      ->check(CLI::IsMember({"mm", "cm", "m"}));
  command->add_option("--up", options->request.up, "Axis that points up, for example --up=-y")
      ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}));
  command->add_option("--crs", options->request.crs, "Coordinate system, EPSG:n");
  command->add_option("--object", options->request.object,
                      "Object of which the model is a survey; created if the project has none");
  command->add_option("--survey", options->request.survey_date,
                      "Date of the survey: YYYY, YYYY-MM or YYYY-MM-DD");
  command
      ->add_option("--resolution", options->request.resolution, "Default resolution of new layers")
      ->check(CLI::IsMember({2048, 4096, 8192, 16384}));
  command
      ->add_option(
          "--weld", options->request.weld_distance,
          "Join vertices closer than this distance, in the file's units; equal vertices are always joined")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--cell", options->request.cell,
                   "For points without triangles: longest edge of the finest triangles, in the "
                   "file's units (default: about 1.5 times the distance between points)")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option(
          "--gap", options->request.gap,
          "For points without triangles: widest gap that the surface closes, in the file's "
          "units (default: 12 times the distance between points)")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--parts", options->request.parts,
                    "Import all scans, also those in named folders, as the parts of one model");
  command->add_flag("--strict", options->request.strict, "Refuse a file that needs repair");
  command
      ->add_option("--server", options->server, "Import into this running server: http://host:port")
      ->envname("STRATA_SERVER");
  command->add_option("--token", options->token, "Token for the server that --server names")
      ->envname("STRATA_OWNER_TOKEN");
  return [options] { return run(*options); };
}

}  // namespace strata::cli
