#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

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
  change,              // M3C2 distance to another model, in mm
  level_of_detection,  // of the change, in mm
  significant_change,  // 0: within the level of detection, 1: gain, 2: loss
  sun_hours,           // of direct sun in a period of the year
  sun_energy,          // of direct sun in a period of the year, in kWh/m²
  driving_rain,        // in l/m²
  vertex_property,
  part,      // the number of the model's part
  lightness  // L* of CIELAB, of the colors of the scan or of a surface image
};
std::string_view name(ShapeKind kind);
std::optional<ShapeKind> parse_shape_kind(std::string_view name);
// Returns whether the values come from the comparison with another model with M3C2.
bool is_change(ShapeKind kind);
// Returns whether the values are those of the sun in a period.
bool is_sun(ShapeKind kind);
// Returns whether the values are numbers of classes, not measurements.
bool has_classes(ShapeKind kind);

// The parameters of a layer that is computed from a model's shape. `completed` replaces empty
// fields by defaults for the model.
struct ShapeRecipe {
  ShapeKind kind = ShapeKind::height;
  std::optional<double> radius_mm;  // curvatures, roughness: radius of the neighborhood
  // ambient occlusion, model distance, changes: largest distance
  std::optional<double> distance_mm;
  // changes: the scales of M3C2 (mesh/analysis/model_change.h)
  std::optional<double> normal_scale_mm, projection_scale_mm, registration_mm;
  std::optional<int> rays;  // ambient occlusion: number of rays
  // Height: the world coordinate instead of the height above the lowest point.
  bool absolute = false;
  // Sun: degrees to the north of the equator.
  std::optional<double> latitude_deg;
  // Sun, rain: degrees clockwise from the model's north axis (domain/scene/compass.h) to true
  // north, seen from above.
  std::optional<double> north_deg;
  std::string from, to;  // sun: the first and last day, in the format MM-DD
  // Rain: the climate (mesh/analysis/rain_sectors.h). Empty: no shares.
  std::vector<double> wind_shares;
  std::optional<double> wind_speed_m_s, rain_mm, rain_mm_per_hour;
  std::string model;  // model distance, changes: id or slug of the other model
  // Vertex property: its name and the source file. Empty: the only source file with this property.
  std::string property, source;
  // Lightness: the id of the surface image. Empty: what is visible by default.
  std::string look;
};

// The days from `from` to `to`, which may be in the next year. Both must be valid.
struct DaysOfYear {
  int first = 0;  // 0: 1 January, in a year of 365 days
  int days = 365;
};
DaysOfYear days_of(const ShapeRecipe& recipe);

// Returns the recipe with defaults for empty fields. `other` is the other model, for kinds that
// compare two models. Returns the Error `invalid` if a field is missing, does not belong to the
// kind, or is out of range for the models. The Error names the field (`compute.radius_mm`).
Result<ShapeRecipe> completed(ShapeRecipe recipe, const Model& model, const Model* other = nullptr);
// Returns the recipe in the format of the body of POST …/layers and of the journal.
nlohmann::json to_json(const ShapeRecipe& recipe);

// Return the unit of the values ("mm", "1/m²", "°", ""), and a description of the values and of
// their computation in a few sentences. `other` is the name of the other model or of the surface
// image.
std::string unit_of(const ShapeRecipe& recipe, const Model& model);
std::string description_of(const ShapeRecipe& recipe, const Model& model, const std::string& other);

// Returns the palette of the parts of a model, with their folders and names.
Palette palette_of(const std::vector<ModelPart>& parts);

// Returns a palette for a kind without parts over the range of the values. `low` and `high` are the
// 2nd and the 98th percentile of the values, `least` and `most` are the ends of their range.
// Palettes of signed values diverge around 0. The palette of azimuths is circular.
struct ValueRange {
  double least = 0, low = 0, high = 1, most = 1;
};
Palette palette_of(ShapeKind kind, const ValueRange& range);

}  // namespace strata::jobs
