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

// The contents of a map file, for a user who is going to paint it.
struct MapContents {
  struct Polygons {
    std::size_t count = 0;
    std::vector<query::MapColumn> columns;
  };
  struct Raster {
    int width = 0, height = 0;
    std::optional<query::MapTiff> tiff;  // nothing: PNG or JPEG
    std::optional<query::WorldFile> world;
    std::vector<query::FoundColor> colors;
  };
  MapKind kind = MapKind::geojson;
  std::string crs;  // empty: the file names none
  // least and greatest coordinates of the map; nothing: the file has no position
  std::optional<std::pair<glm::dvec2, glm::dvec2>> bounds;
  std::variant<Polygons, Raster> parts;
};

// Refuses (invalid, unsupported, busy) the same maps as painting does, except that a missing
// position is allowed.
Result<MapContents> map_contents(const MapFiles& files, const Model& model, double tolerance,
                                 ByteBudget& budget);

}  // namespace strata::app
