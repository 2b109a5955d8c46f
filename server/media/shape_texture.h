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
// is bit y * kShapeSide + x. Its square is laid over the window's square of side 2 · radius around
// each point of a stroke's path, top up.
constexpr int kShapeSide = 256;
using ShapeBits = std::array<std::uint64_t, kShapeSide * kShapeSide / 64>;

// Which part of a picture is the tool: what is opaque, light or dark; all by half and more.
enum class ShapePart { opaque, light, dark };

// The largest centred square around the picture becomes the raster (what lies beside the picture is
// no tool); each cell is the mean of what it covers. Without a `part`: what is opaque where the
// picture has transparency, else what is light. `invalid` where nothing of the picture is the tool.
Result<ShapeBits> shape_of(const Picture& picture, std::optional<ShapePart> part);

// White where the tool is, transparent elsewhere.
Picture picture_of(const ShapeBits& bits);

// A shape made ready for painting. Immutable.
class ShapeTexture {
 public:
  explicit ShapeTexture(const ShapeBits& bits);

  const ShapeBits& bits() const { return bits_; }
  bool is_set(int x, int y) const;
  // Of each cell, row by row: how many steps of a chess king lead to the nearest cell of the tool;
  // 255: so many or more. No cell of the tool lies among those that are nearer, so that a line may
  // leave them out.
  std::span<const std::uint8_t> distances() const { return distances_; }
  // Radius of the largest disc about the centre that lies in the tool, as a share of the radius:
  // 0…1.
  double inner_radius() const { return inner_radius_; }

 private:
  ShapeBits bits_;
  std::vector<std::uint8_t> distances_;
  double inner_radius_ = 1;
};

}  // namespace strata
