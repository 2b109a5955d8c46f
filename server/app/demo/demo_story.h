#pragma once

#include <functional>
#include <string>

#include "app/template_registry.h"
#include "core/error.h"
#include "core/progress.h"
#include "domain/scene/model.h"
#include "store/store.h"

namespace strata::app {

// The people of the demo. Their accounts have no password, so nobody can sign in as them.
inline constexpr const char* kDemoConservator = "lena.demo";
inline constexpr const char* kDemoCurator = "marco.demo";

struct DemoStory {
  Model model;
  std::string kiosk;  // path of the link; empty: it was made by an earlier call
};

// Makes the demo project with a story of eight weeks that ends yesterday: two people map the
// condition of the pot with terms, draw cracks, take samples with photos, discuss, plan and clean;
// suggested strokes wait for review; a saved view is ready for a figure, and a tour has a kiosk
// link. The times are those of the story, not of this call. Idempotent: a project with the story
// stays as it is. Needs the template `stone-condition`. Blocks.
Result<DemoStory> make_demo_story(store::Store& store, const TemplateRegistry& templates,
                                  Progress& progress, double detail = 1.0);

// Erases what make_demo_story makes, with everything that people added to it: the pot with its
// layers, comments, views and tours, and the tables of the story. Other models and tables of the
// project stay. conflict: a layer of another model uses one of the tables. `close_room` is called
// once the model can no longer be opened. Blocks.
Result<void> erase_demo_story(store::Store& store,
                              const std::function<void(ModelId)>& close_room = {});

}  // namespace strata::app
