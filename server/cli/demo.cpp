#include <iostream>

#include "cli/commands.h"
#include "cli/open_database.h"
#include "cli/progress_line.h"
#include "jobs/import_job.h"
#include "store/content/models.h"
#include "store/content/projects.h"

namespace strata::cli {

Command add_demo(CLI::App& app) {
  auto* command = app.add_subcommand(
      "demo", "Create the demo project: a generated pot with two painted layers");
  auto options = std::make_shared<DataOptions>();
  add_data_options(*command, *options);
  auto if_empty = std::make_shared<bool>(false);
  command->add_flag("--if-empty", *if_empty, "Only if the site has no model yet");
  return [options, if_empty] {
    auto database = open_database(*options);
    if (!database) return report(database.error());
    if (*if_empty) {
      auto models = (*database)->store->models().all();
      if (!models) return report(models.error());
      if (!models->empty()) return 0;
    }
    Progress progress;
    auto model = [&] {
      ProgressLine line(progress);
      return jobs::make_demo(*(*database)->store, progress);
    }();
    if (!model) return report(model.error());
    auto projects = (*database)->store->projects().find(to_string(model->project_id));
    std::cout << to_json(*model, projects ? projects->slug : "").dump(2) << std::endl;
    return 0;
  };
}

}  // namespace strata::cli
