#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "media/picture.h"
#include "query/rasters/world_file.h"

namespace strata::query {

// Finds the pixel of a picture of this size at a position; nothing outside of the picture.
class PixelFinder {
 public:
  PixelFinder(int width, int height, const WorldFile& world);
  std::optional<std::size_t> pixel_at(const glm::dvec2& point) const;  // row · width + column
  // In pixels, centers at integers; also outside of the picture.
  glm::dvec2 place_of(const glm::dvec2& point) const {
    return pixel_from_plane_ * (point - first_centre_);
  }

 private:
  int width_, height_;
  glm::dmat2 pixel_from_plane_;
  glm::dvec2 first_centre_;
};

// A picture's colors by positions in the plane.
class PlacedPicture {
 public:
  PlacedPicture(Picture picture, const WorldFile& world);

  // The RGBA pixel at a position; null outside of the picture or where it is less than half opaque.
  const std::uint8_t* pixel_at(const glm::dvec2& point) const;
  // The luminance 0…255 (Rec. 709 weights of the sRGB numbers, rounded).
  std::optional<int> luminance_at(const glm::dvec2& point) const;
  const Picture& picture() const { return picture_; }

 private:
  Picture picture_;
  PixelFinder finder_;
};

}  // namespace strata::query
