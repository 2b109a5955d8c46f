#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/ids.h"
#include "domain/tables/table.h"

namespace strata {

// A line or a point of a record on a model, in addition to texels. Examples are a crack, because
// its repair is paid by the meter, and a sample. Columns of kind `line` and `point` hold lists of
// features: `[{"model": 3, "coordinates": [[x, y, z], …]}]`. Coordinates are world coordinates in
// the unit of the model. The surface is straight between neighboring points of a line.
struct SurfaceFeature {
  ModelId model = 0;
  std::vector<glm::dvec3> places;  // one point, or two or more points of a line
  bool operator==(const SurfaceFeature&) const = default;
};

struct KeyFeature {  // a feature of the record with the key
  std::int64_t key = 0;
  SurfaceFeature feature;
  int part = 0;  // the model's part at the first position, as determined by an open room
  bool operator==(const KeyFeature&) const = default;
};

inline constexpr std::size_t kMaxFeatures = 1000;         // per cell
inline constexpr std::size_t kMaxFeaturePlaces = 10'000;  // per cell
inline constexpr double kMaxFeatureCoordinate = 1e12;

// Reads the features in the value of a cell. Returns nullopt if the features have another kind or
// exceed the limits above.
std::optional<std::vector<SurfaceFeature>> read_features(const nlohmann::json& value, bool lines);
nlohmann::json to_json(std::span<const SurfaceFeature> features);
// Returns the features of a record in a column of lines or points, or none without a value.
std::vector<SurfaceFeature> features_of(const Record& record, const Column& column);

// Prints and parses the form for CSV cells: `3 LINESTRING Z (0 0 1, 2.5 0 1); 3 POINT Z (1 2 3)`.
// The id of the model precedes the well-known text (ISO 13249-3).
std::string print_features(std::span<const SurfaceFeature> features, bool lines);
std::optional<std::vector<SurfaceFeature>> parse_features(std::string_view text, bool lines);

double length_of(const SurfaceFeature& feature);  // in the unit of the model; 0 for a point

}  // namespace strata
