#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/error.h"
#include "media/picture.h"

namespace strata {

// The shape of a tool as a raster of cells that belong to it or not: row 0 at the top, cell (x, y)
// is bit y * kShapeSide + x. Around each point of a stroke's path, the raster covers the window's
// square of side 2 · radius, top up.
constexpr int kShapeSide = 256;
using ShapeBits = std::array<std::uint64_t, kShapeSide * kShapeSide / 64>;

// The part of a picture that is the tool: opaque, light or dark pixels, each from one half on.
enum class ShapePart { opaque, light, dark };

// Converts the smallest square around the centered picture to the raster (the area outside the
// picture is empty); each cell is the mean of its pixels. Without a `part`: the opaque part if the
// picture has transparency, otherwise the light one. `invalid`: no part of it is the tool.
Result<ShapeBits> shape_of(const Picture& picture, std::optional<ShapePart> part);

// Returns a picture that is white in the tool and transparent elsewhere.
Picture picture_of(const ShapeBits& bits);

// A shape prepared for painting. Immutable.
class ShapeTexture {
 public:
  explicit ShapeTexture(const ShapeBits& bits);

  const ShapeBits& bits() const { return bits_; }
  bool is_set(int x, int y) const;
  // Returns the chessboard distance of each cell, row by row, to the nearest cell of the tool; 255:
  // so far or farther. Nearer cells do not belong to the tool, so a line can skip them.
  std::span<const std::uint8_t> distances() const { return distances_; }
  // Returns the radius of the largest disc around the center inside the tool, as a share of the
  // radius: 0…1.
  double inner_radius() const { return inner_radius_; }

 private:
  ShapeBits bits_;
  std::vector<std::uint8_t> distances_;
  double inner_radius_ = 1;
};

}  // namespace strata
