#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/error.h"
#include "domain/layers/palette.h"
#include "domain/scene/model.h"

namespace strata::jobs {

// The kinds of layers that are computed from the shape.
enum class ShapeKind {
  height,
  slope,
  azimuth,
  mean_curvature,
  gaussian_curvature,
  max_curvature,
  min_curvature,
  roughness,
  ambient_occlusion,
  boundary_distance,
  model_distance,
  vertex_property
};
std::string_view name(ShapeKind kind);
std::optional<ShapeKind> parse_shape_kind(std::string_view name);

// The parameters of a layer that is computed from a model's shape. Empty members take a default
// that suits the model (`completed`).
struct ShapeRecipe {
  ShapeKind kind = ShapeKind::height;
  std::optional<double> radius_mm;    // curvatures, roughness: of the neighborhood
  std::optional<double> distance_mm;  // ambient occlusion, model distance: maximum distance
  std::optional<int> rays;            // ambient occlusion
  // height: the world's coordinate, not the height above the lowest point
  bool absolute = false;
  std::string model;  // model distance: the other model, id or slug
  // vertex property: its name, and the source file ("": the only one that has it)
  std::string property, source;
};

// `invalid` naming the member (`compute.radius_mm`) if it does not belong to the kind, is missing,
// or is out of range for the model.
Result<ShapeRecipe> completed(ShapeRecipe recipe, const Model& model);
// as in the body of POST …/layers, and as in the journal
nlohmann::json to_json(const ShapeRecipe& recipe);

// Return the unit of the values ("mm", "1/m²", "°", ""), and a description of the values and of
// their computation in a few plain sentences.
std::string unit_of(const ShapeRecipe& recipe, const Model& model);
std::string description_of(const ShapeRecipe& recipe, const Model& model,
                           const std::string& other_model);

// Returns colors that suit the kind, over the range of the values: `low` and `high` are its 2nd and
// 98th percentile, `least` and `most` its ends. Diverging around 0 for signed values, a circle for
// azimuths.
struct ValueRange {
  double least = 0, low = 0, high = 1, most = 1;
};
Palette palette_of(ShapeKind kind, const ValueRange& range);

}  // namespace strata::jobs
