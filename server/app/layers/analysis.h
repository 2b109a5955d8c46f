#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/layers/new_layers.h"
#include "app/services.h"
#include "core/error.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "jobs/shape_recipe.h"
#include "query/statistics/statistics.h"
#include "room/queries.h"
#include "room/room.h"

// Analyses: computed layers and statistics of one model, one after another. A step can read the
// layers of the steps before it.
namespace strata::app {

struct AnalysisStep {
  // A layer that is computed from the shape of the model or by an expression.
  struct Compute {
    Layer layer;                                // without its formula
    std::optional<jobs::ShapeRecipe> recipe{};  // from check_recipe
    std::string expression{};                   // if there is no recipe
    bool automatic = false;                     // as in LayerFormula
    bool has_palette = false;                   // otherwise it is fitted to the values
  };
  struct Measure {
    std::string layer;                   // id or slug
    std::optional<std::string> where{};  // a condition
    room::StatisticsOptions options{};
  };
  std::variant<Compute, Measure> work;
};

struct Analysis {
  std::string name;
  std::vector<AnalysisStep> steps{};
};

// Returns the layers of the room, and then those of the steps, which have no id yet.
std::vector<Layer> layers_after(const room::Room& room, const Analysis& analysis);

// Checks a step and adds it to the analysis. Refuses a layer whose slug the model or an earlier
// step already uses (409), and an entity that the step names but that does not exist (422). The
// error names a member of the step, as in POST …/layers. Blocks.
Result<void> add_step(const Services& services, const room::Room& room, Role role,
                      Analysis& analysis, AnalysisStep step);

// Returns the error of a step with the path of its field: `steps[1].layer.expression` for `index`
// 1, `member` "layer" and the field "expression".
tl::unexpected<Error> at_step(Error problem, std::size_t index, std::string_view member);

struct AnalysisResult {
  Layer layer;                // the new layer, or the layer with the statistics
  std::vector<Layer> inputs;  // that the step read, by slug
  // Of the model: the state of the inputs that the step read. Nothing for a layer that is computed
  // from the shape.
  std::optional<std::int64_t> sequence{};
  std::optional<query::Statistics> statistics{};
};

// Runs the steps and returns their results, in the same order. `layers` gets the new layers. Each
// of them names the analysis (Layer::analysis). After an error, the caller must call
// `layers.take_back()`. The detail of an error names the step, and its field is as in `at_step`.
// Blocks.
Result<std::vector<AnalysisResult>> run_analysis(const Services& services,
                                                 const std::shared_ptr<room::Room>& room,
                                                 const Analysis& analysis, const Author& author,
                                                 NewLayers& layers, Progress& progress);

}  // namespace strata::app
