#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/picture.h"
#include "core/polygon_area.h"

namespace strata::query {

// Maps in a plane: polygons with a value each, and pictures that stand in it. Coordinates are the plane's, in model units.

struct MapArea {
  PolygonArea area;
  double value = 0;
};

constexpr std::size_t kMaxMapPoints = 2'000'000;

// The polygons of a GeoJSON text (RFC 7946: a FeatureCollection, a Feature or a geometry of Polygons and MultiPolygons), in
// their order; features without a geometry are passed over. Each has the number that its property `attribute` holds, or `value`
// where none is named. Further coordinates of a position are passed over. Refused (400, 422 with the place in the text):
// what is no GeoJSON, points and lines, rings of fewer than three points, a feature without that number, no polygon at all, more
// than kMaxMapPoints points.
Result<std::vector<MapArea>> parse_map_areas(std::string_view geojson, const std::string& attribute, double value);

// The last of the areas that a point lies in: later ones lie on top.
std::optional<double> value_at(const std::vector<MapArea>& areas, const glm::dvec2& point);

// How a picture stands in the plane: the six lines of a world file. The centre of pixel (column, row) lies at
// (x_per_column · column + x_per_row · row + x, y_per_column · column + y_per_row · row + y).
struct WorldFile {
  double x_per_column = 1, y_per_column = 0, x_per_row = 0, y_per_row = -1, x = 0, y = 0;
};
// "1,0,0,-1,0,0" in the order of a world file's lines, parted by commas, blanks or line ends. Refused (422 at `field`): another
// count, no finite numbers, a picture without area.
Result<WorldFile> parse_world_file(std::string_view text, const std::string& field);

// A picture's colours by places in the plane.
class PlacedPicture {
 public:
  PlacedPicture(Picture picture, const WorldFile& world);
  // Luminance 0…255 of the pixel there (Rec. 709 weights of the sRGB numbers, rounded); nothing outside of the picture or where
  // less than half is opaque.
  std::optional<int> luminance_at(const glm::dvec2& point) const;

 private:
  Picture picture_;
  glm::dmat2 pixel_from_plane_;
  glm::dvec2 first_centre_;
};

}  // namespace strata::query
