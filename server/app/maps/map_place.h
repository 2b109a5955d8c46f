#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "app/maps/map_files.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "query/maps/color_keys.h"
#include "query/maps/map_tiff.h"

// The position of a map on a model, and the user's options for the map.
namespace strata::app {

constexpr int kMaxMapSide = 16384;  // in pixels

// The options for a map that a user sends in addition to its files. The texts are not parsed yet.
struct MapOptions {
  std::optional<std::string> world;  // the six numbers of a world file
  std::string crs;                   // coordinate system that the user confirms
  // For polygons, either `value` or `attribute` is set.
  std::optional<double> value;
  std::string attribute;
  std::string names;  // attribute with the names for the numbers in `attribute`
  // For images, at most one of `colors` and `band` is set.
  std::optional<std::string> colors;          // "auto", or colors with their values
  std::optional<int> band;                    // of a TIFF, starting at 1
  double tolerance = query::kUsualTolerance;  // when comparing colors
};

// The direction of view. For "-z", the map shows the model from above, and its coordinates are x
// and y. Along y, they are x and z. Along x, they are y and z.
struct MapAxis {
  glm::dvec3 direction;
  int u, v;  // indices of the world coordinates along the map's axes
  glm::dvec2 on_map(const glm::dvec3& world) const { return {world[u], world[v]}; }
};
// Parses an axis with its sign. Refuses (invalid, `along`) other text.
Result<MapAxis> parse_map_axis(std::string_view text);

// Returns the code of the model's coordinate system if the unit is the meter and the model is seen
// along z (`depth` is 2), as on a map. Otherwise returns 0.
int epsg_of(const Model& model, int depth);

// Returns the mean area of a texel of a layer on the surface, in the square of the model's unit,
// and 0 if the atlas covers nothing.
double texel_area(const Model& model, int resolution);

// Returns the position of the map from the options, from a world file, or from the tags in the
// image, in this order. Refuses (invalid) a map without any of these.
Result<query::WorldFile> world_of(const MapOptions& options, const MapFiles& files,
                                  const std::optional<query::WorldFile>& own);

// Refuses a map whose file names a coordinate system other than the model's.
Result<void> check_map_crs(const Model& model, const std::string& crs, bool in_degrees);

// If the map names a coordinate system and the model has none, the user must confirm that both use
// the same coordinates. The option `crs` must then name that system. Refuses (invalid, at `crs`) a
// missing name, and a name other than the map's or the model's.
Result<void> confirm_map_crs(const MapOptions& options, const Model& model, const std::string& crs);

// Encodes a value for the layer. In an error, `where` describes the origin of the value.
Result<std::uint32_t> bits_of(const Layer& layer, double value, const std::string& where);

}  // namespace strata::app
