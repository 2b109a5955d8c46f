#include "query/rasters/world_file.h"

#include <array>
#include <charconv>
#include <cmath>

namespace strata::query {

Result<WorldFile> checked(const WorldFile& world, const std::string& field) {
  for (const double number :
       {world.x_per_column, world.y_per_column, world.x_per_row, world.y_per_row, world.x, world.y})
    if (!std::isfinite(number))
      return fail(ErrorCode::invalid, "Invalid world file",
                  "The numbers of the world file must be finite.", field);
  const double area = world.x_per_column * world.y_per_row - world.x_per_row * world.y_per_column;
  if (!std::isnormal(area))
    return fail(ErrorCode::invalid, "Invalid world file",
                "The world file must define pixels with an area greater than 0.", field);
  return world;
}

Result<WorldFile> parse_world_file(std::string_view text, const std::string& field) {
  std::array<double, 6> numbers{};
  std::size_t count = 0;
  const auto wrong = [&] {
    return fail(ErrorCode::invalid, "Invalid world file",
                "A world file must contain six numbers: size and rotation of a pixel in x and y, "
                "then the center of the first pixel.",
                field);
  };
  const auto is_gap = [](char c) {
    return c == ',' || c == ' ' || c == '\n' || c == '\r' || c == '\t';
  };
  for (std::size_t at = 0; at < text.size();) {
    if (is_gap(text[at])) {
      ++at;
      continue;
    }
    if (count == numbers.size()) return wrong();
    const auto [end, error] =
        std::from_chars(text.data() + at, text.data() + text.size(), numbers[count]);
    if (error != std::errc() || !std::isfinite(numbers[count])) return wrong();
    ++count;
    at = static_cast<std::size_t>(end - text.data());
    if (at < text.size() && !is_gap(text[at])) return wrong();
  }
  if (count != numbers.size()) return wrong();
  return checked({numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]}, field);
}

}  // namespace strata::query
