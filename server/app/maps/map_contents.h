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

// What a map file holds, for a user who is going to paint it.
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
  // least and greatest coordinates of the map; nothing: the file does not say where it lies
  std::optional<std::pair<glm::dvec2, glm::dvec2>> bounds;
  std::variant<Polygons, Raster> parts;
};

// Refused (invalid, unsupported, busy): what painting the map would refuse, but for a missing
// place.
Result<MapContents> map_contents(const MapFiles& files, const Model& model, double tolerance,
                                 ByteBudget& budget);

}  // namespace strata::app
