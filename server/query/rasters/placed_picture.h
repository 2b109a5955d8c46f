#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "media/picture.h"
#include "query/rasters/world_file.h"

namespace strata::query {

// Finds the pixel of an image at a position in the plane. Finds nothing outside the image.
class PixelFinder {
 public:
  PixelFinder(int width, int height, const WorldFile& world);
  std::optional<std::size_t> pixel_at(const glm::dvec2& point) const;  // row · width + column
  // Returns a position in pixels, with centers at integers. The position may be outside the image.
  glm::dvec2 place_of(const glm::dvec2& point) const {
    return pixel_from_plane_ * (point - first_centre_);
  }

 private:
  int width_, height_;
  glm::dmat2 pixel_from_plane_;
  glm::dvec2 first_centre_;
};

// The colors of an image by position in the plane.
class PlacedPicture {
 public:
  PlacedPicture(Picture picture, const WorldFile& world);

  // Returns the RGBA pixel at a position. Returns null outside the image, and for a pixel that is
  // less than half opaque.
  const std::uint8_t* pixel_at(const glm::dvec2& point) const;
  // Returns the luminance from 0 to 255 (sRGB numbers with the weights of Rec. 709, rounded).
  std::optional<int> luminance_at(const glm::dvec2& point) const;
  const Picture& picture() const { return picture_; }

 private:
  Picture picture_;
  PixelFinder finder_;
};

}  // namespace strata::query
