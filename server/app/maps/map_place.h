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

// Where flat maps lie on a model, and what users say of them.
namespace strata::app {

constexpr int kMaxMapSide = 16384;  // pixels

// What a user says of a map besides its files. Texts are as the user wrote them.
struct MapOptions {
  std::optional<std::string> world;  // the six numbers of a world file
  std::string crs;                   // the coordinate system that the user confirms
  // of polygons: exactly one of the two
  std::optional<double> value;
  std::string attribute;
  std::string names;  // attribute that names the numbers of `attribute`
  // of pictures: one of the two, or neither
  std::optional<std::string> colors;          // "auto", or colours with their values
  std::optional<int> band;                    // of a TIFF, from 1
  double tolerance = query::kUsualTolerance;  // of colours
};

// "-z": seen from above, map coordinates are x and y; along y they are x and z, along x y and z.
struct MapAxis {
  glm::dvec3 direction;
  int u, v;  // which of the world's coordinates the map's are
  glm::dvec2 on_map(const glm::dvec3& world) const { return {world[u], world[v]}; }
};
// Refused (invalid, `along`): other text than an axis with its sign.
Result<MapAxis> parse_map_axis(std::string_view text);

// From the options, a world file beside the picture, or the picture's own tags, in this order.
// Refused (invalid): none of them.
Result<query::WorldFile> world_of(const MapOptions& options, const MapFiles& files,
                                  const std::optional<query::WorldFile>& own);

// Refuses a map that says that it lies in another coordinate system than the model.
Result<void> check_map_crs(const Model& model, const std::string& crs, bool in_degrees);

// The user has to say that a map's coordinates are the model's where the map names a system and
// the model has none: `crs` of the options names that system. Refused (invalid, at `crs`): it is
// absent, or another one than the map's or the model's.
Result<void> confirm_map_crs(const MapOptions& options, const Model& model, const std::string& crs);

// The bits of a value in the layer; `where` tells what held it.
Result<std::uint32_t> bits_of(const Layer& layer, double value, const std::string& where);

}  // namespace strata::app
