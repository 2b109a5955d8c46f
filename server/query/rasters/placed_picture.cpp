#include "query/rasters/placed_picture.h"

#include <cmath>

namespace strata::query {

PixelFinder::PixelFinder(int width, int height, const WorldFile& world)
    : width_(width),
      height_(height),
      pixel_from_plane_(glm::inverse(
          glm::dmat2(world.x_per_column, world.y_per_column, world.x_per_row, world.y_per_row))),
      first_centre_(world.x, world.y) {}

std::optional<std::size_t> PixelFinder::pixel_at(const glm::dvec2& point) const {
  const glm::dvec2 pixel = place_of(point) + 0.5;
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < width_ && pixel.y < height_)) return std::nullopt;
  return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(width_) +
         static_cast<std::size_t>(pixel.x);
}

PlacedPicture::PlacedPicture(Picture picture, const WorldFile& world)
    : picture_(std::move(picture)), finder_(picture_.width, picture_.height, world) {}

const std::uint8_t* PlacedPicture::pixel_at(const glm::dvec2& point) const {
  const auto pixel = finder_.pixel_at(point);
  if (!pixel) return nullptr;
  const std::uint8_t* rgba = &picture_.rgba[4 * *pixel];
  return rgba[3] < 128 ? nullptr : rgba;
}

std::optional<int> PlacedPicture::luminance_at(const glm::dvec2& point) const {
  const std::uint8_t* rgba = pixel_at(point);
  if (!rgba) return std::nullopt;
  return static_cast<int>(std::lround(0.2126 * rgba[0] + 0.7152 * rgba[1] + 0.0722 * rgba[2]));
}

}  // namespace strata::query
