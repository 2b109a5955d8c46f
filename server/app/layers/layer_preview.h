#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "app/services.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "jobs/shape_recipe.h"
#include "query/statistics/statistics.h"
#include "room/queries.h"
#include "room/room.h"

namespace strata::app {

// The largest resolution of a preview, in texels on each side.
constexpr int kPreviewResolution = 1024;

// What a computed layer would contain, with fewer texels.
struct LayerPreview {
  Layer layer;                     // with the resolution and the palette of the preview, and a unit
  query::Statistics statistics;    // with quantiles
  double share = 0;                // of the surface that has a value
  std::vector<std::uint8_t> rgba;  // query::picture_of_values
};

// Computes a layer that does not exist, from its formula or from `recipe`, and changes nothing. Its
// resolution is at most kPreviewResolution, or the lowest of the model. Returns the errors of
// add_formula_layer and add_shape_layer. Blocks. Fails when `progress` is cancelled, and throws
// QuestionEnded if the current question ends.
Result<LayerPreview> preview_layer(const Services& services, room::Room& room, Layer layer,
                                   const std::optional<jobs::ShapeRecipe>& recipe, bool has_palette,
                                   const Author& author, const room::SeenGrid& grid,
                                   Progress& progress);

}  // namespace strata::app
