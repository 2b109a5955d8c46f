#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/maps/map_values.h"
#include "core/byte_budget.h"
#include "query/maps/color_keys.h"

namespace strata::app {

// The contents of a map file, for a user who is about to paint the map.
struct MapContents {
  struct Polygons {
    std::size_t count = 0;
    std::vector<query::MapColumn> columns;
  };
  struct Raster {
    int width = 0, height = 0;
    std::optional<query::MapTiff> tiff;  // empty for PNG or JPEG
    std::optional<query::WorldFile> world;
    std::vector<query::FoundColor> colors;
  };
  MapKind kind = MapKind::geojson;
  std::string crs;  // empty if the file names no system
  // The minimum and maximum coordinates of the map. Empty if the file contains no position.
  std::optional<std::pair<glm::dvec2, glm::dvec2>> bounds;
  std::variant<Polygons, Raster> parts;
};

// Returns the contents. Refuses the same maps as painting does (invalid, unsupported, busy) but
// allows a missing position.
Result<MapContents> map_contents(const MapFiles& files, const Model& model, double tolerance,
                                 ByteBudget& budget);

}  // namespace strata::app
