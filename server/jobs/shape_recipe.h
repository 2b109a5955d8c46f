#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/error.h"
#include "domain/layers/palette.h"
#include "domain/scene/model.h"

namespace strata::jobs {

// What a layer can be computed from.
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

// How a layer is made from a model's shape. What is not set takes a default that suits the model
// (`completed`).
struct ShapeRecipe {
  ShapeKind kind = ShapeKind::height;
  std::optional<double> radius_mm;    // curvatures, roughness: of the neighbourhood
  std::optional<double> distance_mm;  // ambient occlusion, model distance: as far as it looks
  std::optional<int> rays;            // ambient occlusion
  // height: the world's coordinate, not that above the lowest point
  bool absolute = false;
  std::string model;  // model distance: the other one, id or slug
  // vertex property: its name, and the source file ("": the only one that has it)
  std::string property, source;
};

// `invalid` naming the member (`compute.radius_mm`) for what does not belong to the kind, is
// missing, or is out of range for the model.
Result<ShapeRecipe> completed(ShapeRecipe recipe, const Model& model);
// as POST …/layers takes it, and as the journal keeps it
nlohmann::json to_json(const ShapeRecipe& recipe);

// Unit of the values ("mm", "1/m²", "°", ""), and what they are and how they were made, in a few
// plain sentences.
std::string unit_of(const ShapeRecipe& recipe, const Model& model);
std::string description_of(const ShapeRecipe& recipe, const Model& model,
                           const std::string& other_model);

// Colours that suit the kind, over the range that the values have: `low` and `high` are its 2nd and
// 98th percentile, `least` and `most` its ends. Diverging around 0 for what has a sign, a circle
// for azimuths.
struct ValueRange {
  double least = 0, low = 0, high = 1, most = 1;
};
Palette palette_of(ShapeKind kind, const ValueRange& range);

}  // namespace strata::jobs
