#pragma once

#include <functional>
#include <string>

#include "app/template_registry.h"
#include "core/error.h"
#include "core/progress.h"
#include "domain/scene/model.h"
#include "store/store.h"

namespace strata::app {

// The demo users. Their accounts have no passwords, so no visitor can sign in with them.
inline constexpr const char* kDemoConservator = "lena.demo";
inline constexpr const char* kDemoCurator = "marco.demo";

struct DemoStory {
  Model model;
  std::string kiosk;  // path of the link; empty if an earlier call created it
};

// Creates the demo project with a story of eight weeks that ends yesterday. Two users map the
// condition of the pot with terms, draw cracks, take samples with photos, discuss, plan and clean.
// Some strokes are suggestions that wait for review. There is a saved view for a figure, and a tour
// with a kiosk link. All stored times are times of the story. Idempotent: does not change a project
// that already contains the story. Requires the template `stone-condition`.
// Blocks.
Result<DemoStory> make_demo_story(store::Store& store, const TemplateRegistry& templates,
                                  Progress& progress, double detail = 1.0);

// Erases the content that make_demo_story creates, including all additions of users. This is the
// pot with its layers, comments, views and tours, and the tables of the story. Keeps other models
// and tables of the project. Returns conflict if a layer of another model uses one of the tables.
// Calls `close_room` when the model can no longer be opened. Blocks.
Result<void> erase_demo_story(store::Store& store,
                              const std::function<void(ModelId)>& close_room = {});

}  // namespace strata::app
