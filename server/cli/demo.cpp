#include <iostream>

#include "app/demo/demo_story.h"
#include "app/template_registry.h"
#include "cli/commands.h"
#include "cli/install_dirs.h"
#include "cli/open_database.h"
#include "cli/progress_line.h"
#include "jobs/import_job.h"
#include "store/content/models.h"
#include "store/content/projects.h"

namespace strata::cli {
namespace {

struct DemoOptions {
  DataOptions data;
  bool if_empty = false, pot_only = false, reset = false;
};

Result<app::DemoStory> make(store::Store& store, const DemoOptions& options) {
  Progress progress;
  ProgressLine line(progress);
  if (options.pot_only) {
    auto model = STRATA_TRY(jobs::make_demo(store, progress));
    return app::DemoStory{std::move(model), {}};
  }
  const auto templates = STRATA_TRY(app::TemplateRegistry::load(install_dirs().templates));
  if (options.reset) STRATA_TRY(app::erase_demo_story(store));
  return app::make_demo_story(store, templates, progress);
}

}  // namespace

Command add_demo(CLI::App& app) {
  auto* command = app.add_subcommand(
      "demo", "Create the demo project: a generated pot with the work of two fictional people");
  auto options = std::make_shared<DemoOptions>();
  add_data_options(*command, options->data);
  add_files_options(*command, options->data);
  command->add_flag("--if-empty", options->if_empty, "Do nothing if the site has a model");
  auto* pot_only = command->add_flag("--pot-only", options->pot_only,
                                     "Create only the pot with two painted layers");
  command
      ->add_flag("--reset", options->reset,
                 "Erase the pot of the demo with everything on it, and create it again")
      ->excludes(pot_only);
  return [options] {
    auto database = open_database(options->data);
    if (!database) return report(database.error());
    store::Store& store = *(*database)->store;
    if (options->if_empty) {
      auto models = store.models().all();
      if (!models) return report(models.error());
      if (!models->empty()) return 0;
    }
    const auto made = make(store, *options);
    if (!made) return report(made.error());
    auto projects = store.projects().find(to_string(made->model.project_id));
    nlohmann::json json = to_json(made->model, projects ? projects->slug : "");
    if (!made->kiosk.empty()) json["kiosk"] = made->kiosk;
    std::cout << json.dump(2) << std::endl;
    return 0;
  };
}

}  // namespace strata::cli
