#pragma once

#include <string>
#include <string_view>

#include "core/error.h"

namespace strata::query {

// The position of an image in the plane: the six lines of a world file. The center of pixel
// (column, row) is at (x_per_column · column + x_per_row · row + x, y_per_column · column +
// y_per_row · row + y).
struct WorldFile {
  double x_per_column = 1, y_per_column = 0, x_per_row = 0, y_per_row = -1, x = 0, y = 0;
};
// Parses six numbers, such as "1,0,0,-1,0,0", in the order of the lines of a world file. They are
// separated by commas, blanks or line ends. Returns an `invalid` error at `field` for another
// count, for numbers that are not finite, and for an image without area.
Result<WorldFile> parse_world_file(std::string_view text, const std::string& field);
// Makes these checks for values from another source, such as GeoTIFF tags.
Result<WorldFile> checked(const WorldFile& world, const std::string& field);

}  // namespace strata::query
