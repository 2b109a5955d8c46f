#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "core/layer.h"
#include "core/model.h"
#include "net/http/http_types.h"
#include "net/map_files.h"
#include "query/map_tiff.h"

namespace strata::net {

// What requests with flat maps have in common.

constexpr std::uint64_t kMaxMapBytes = 256u << 20;
constexpr int kLargestMapSide = 16384;  // pixels

// A number of the query; `fallback` where it is absent. Refused (422): no number, out of range,
// absent without a fallback.
Result<double> number_of(const Request& request, const std::string& name, double low, double high,
                         std::optional<double> fallback = {});

// "-z": seen from above, map coordinates are x and y; along y they are x and z, along x y and z.
struct MapAxis {
  glm::dvec3 direction;
  int u, v;  // which of the world's coordinates the map's are
  glm::dvec2 on_map(const glm::dvec3& world) const { return {world[u], world[v]}; }
};
Result<MapAxis> axis_of(const Request& request);

// From the query's `world`, a world file beside the picture, or the picture's own tags, in this
// order. Refused (422): none of them.
Result<query::WorldFile> world_of(const Request& request, const MapFiles& files,
                                  const std::optional<query::WorldFile>& own);

// Refuses a map that says that it lies in another coordinate system than the model.
Result<void> check_map_crs(const Model& model, const std::string& crs, bool in_degrees);

// The caller has to say that a map's coordinates are the model's where the map names a system and
// the model has none: `crs` of the query names that system. Refused (422, at `crs`): it is absent,
// or another one than the map's or the model's.
Result<void> confirm_map_crs(const Request& request, const Model& model, const std::string& crs);

// The bits of a value in the layer; `where` tells what held it.
Result<std::uint32_t> bits_of(const Layer& layer, double value, const std::string& where);

}  // namespace strata::net
