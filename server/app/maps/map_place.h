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

// The position of maps on a model, and the user's options for them.
namespace strata::app {

constexpr int kMaxMapSide = 16384;  // pixels

// A user's options for a map, in addition to its files. Texts are as the user wrote them.
struct MapOptions {
  std::optional<std::string> world;  // the six numbers of a world file
  std::string crs;                   // the coordinate system that the user confirms
  // for polygons: exactly one of the two
  std::optional<double> value;
  std::string attribute;
  std::string names;  // attribute that names the numbers of `attribute`
  // for pictures: one of the two, or neither
  std::optional<std::string> colors;          // "auto", or colors with their values
  std::optional<int> band;                    // of a TIFF, from 1
  double tolerance = query::kUsualTolerance;  // of colors
};

// "-z": seen from above, map coordinates are x and y; along y they are x and z, along x y and z.
struct MapAxis {
  glm::dvec3 direction;
  int u, v;  // the world coordinates of the map's two axes
  glm::dvec2 on_map(const glm::dvec3& world) const { return {world[u], world[v]}; }
};
// Refuses (invalid, `along`) other text than an axis with its sign.
Result<MapAxis> parse_map_axis(std::string_view text);

// Returns the map's position from the options, a world file, or the picture's tags, in this order.
// Refuses (invalid) a map without any of them.
Result<query::WorldFile> world_of(const MapOptions& options, const MapFiles& files,
                                  const std::optional<query::WorldFile>& own);

// Refuses a map whose file names another coordinate system than the model's.
Result<void> check_map_crs(const Model& model, const std::string& crs, bool in_degrees);

// If the map names a coordinate system and the model has none, the user must confirm that their
// coordinates are the same: `crs` of the options names that system. Refuses (invalid, at `crs`) an
// absent name, or another one than the map's or the model's.
Result<void> confirm_map_crs(const MapOptions& options, const Model& model, const std::string& crs);

// Encodes a value for the layer; `where` names its origin in the error.
Result<std::uint32_t> bits_of(const Layer& layer, double value, const std::string& where);

}  // namespace strata::app
