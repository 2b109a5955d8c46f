#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/error.h"
#include "media/picture.h"

namespace strata {

// The shape of a tool as a raster: a set cell belongs to the tool. The first row is the top row,
// and cell (x, y) is bit y * kShapeSide + x. At each point of a stroke's path, the raster covers a
// square of the window with side 2 · radius.
constexpr int kShapeSide = 256;
using ShapeBits = std::array<std::uint64_t, kShapeSide * kShapeSide / 64>;

// The part of an image that is the tool: pixels that are at least half opaque, light or dark.
enum class ShapePart { opaque, light, dark };

// Converts an image to the raster. The image is centered in the smallest square that contains it,
// and the area outside it is empty. Each cell is the mean of its pixels. Without `part`, the tool
// is the opaque part of an image with transparency, or the light part of an image without it.
// Returns the Error `invalid` if no cell belongs to the tool.
Result<ShapeBits> shape_of(const Picture& picture, std::optional<ShapePart> part);

// Returns an image that is white in the tool and transparent elsewhere.
Picture picture_of(const ShapeBits& bits);

// A shape, prepared for painting. Immutable.
class ShapeTexture {
 public:
  explicit ShapeTexture(const ShapeBits& bits);

  const ShapeBits& bits() const { return bits_; }
  bool is_set(int x, int y) const;
  // Returns the chessboard distance of each cell to the nearest cell of the tool, row by row. 255
  // means a distance of 255 or more. A search along a line can skip all nearer cells, because they
  // do not belong to the tool.
  std::span<const std::uint8_t> distances() const { return distances_; }
  // Returns the radius of the largest disc that is inside the tool and shares its center, as a
  // share of the tool's radius: 0…1.
  double inner_radius() const { return inner_radius_; }

 private:
  ShapeBits bits_;
  std::vector<std::uint8_t> distances_;
  double inner_radius_ = 1;
};

}  // namespace strata
