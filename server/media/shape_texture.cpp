#include "media/shape_texture.h"

#include <algorithm>
#include <cmath>

namespace strata {
namespace {

constexpr double kMinShare = 0.5;  // smallest share of a set cell's area in the tool

bool has_transparency(const Picture& picture) {
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4)
    if (picture.rgba[i] != 255) return true;
  return false;
}

// Returns the share of a pixel that belongs to the tool, 0…255. Transparent pixels are neither
// light nor dark.
std::uint32_t weight(const std::uint8_t* rgba, ShapePart part) {
  const std::uint32_t alpha = rgba[3];
  if (part == ShapePart::opaque) return alpha;
  const std::uint32_t luma = (2126u * rgba[0] + 7152u * rgba[1] + 722u * rgba[2]) / 10000u;
  return (part == ShapePart::light ? luma : 255u - luma) * alpha / 255u;
}

// The sums of weights over rectangles from the corner of the image. Bilinear between pixels.
class WeightSums {
 public:
  WeightSums(const Picture& picture, ShapePart part)
      : width_(picture.width), height_(picture.height), sums_(row(picture.height + 1)) {
    for (int y = 0; y < height_; ++y) {
      std::uint64_t so_far = 0;
      for (int x = 0; x < width_; ++x) {
        so_far += weight(&picture.rgba[4 * (std::size_t(y) * std::size_t(width_) + std::size_t(x))],
                         part);
        sums_[row(y + 1) + std::size_t(x) + 1] = sums_[row(y) + std::size_t(x) + 1] + so_far;
      }
    }
  }
  double up_to(double x, double y) const {
    x = std::clamp(x, 0.0, double(width_));
    y = std::clamp(y, 0.0, double(height_));
    const int left = std::min(int(x), width_ - 1), top = std::min(int(y), height_ - 1);
    const auto at = [&](int column, int line) {
      return double(sums_[row(line) + std::size_t(column)]);
    };
    const double u = x - left, v = y - top;
    return (at(left, top) * (1 - u) + at(left + 1, top) * u) * (1 - v) +
           (at(left, top + 1) * (1 - u) + at(left + 1, top + 1) * u) * v;
  }

 private:
  std::size_t row(int y) const { return std::size_t(y) * std::size_t(width_ + 1); }
  int width_, height_;
  std::vector<std::uint64_t> sums_;
};

}  // namespace

Result<ShapeBits> shape_of(const Picture& picture, std::optional<ShapePart> part) {
  const WeightSums sums(
      picture, part.value_or(has_transparency(picture) ? ShapePart::opaque : ShapePart::light));
  const double side = std::max(picture.width, picture.height), cell = side / kShapeSide;
  const double left = (picture.width - side) / 2, top = (picture.height - side) / 2;
  ShapeBits bits{};
  bool any = false;
  for (int y = 0; y < kShapeSide; ++y) {
    for (int x = 0; x < kShapeSide; ++x) {
      const double x0 = left + x * cell, y0 = top + y * cell, x1 = x0 + cell, y1 = y0 + cell;
      const double sum =
          sums.up_to(x1, y1) - sums.up_to(x0, y1) - sums.up_to(x1, y0) + sums.up_to(x0, y0);
      if (sum < kMinShare * 255 * cell * cell) continue;
      const auto bit = static_cast<std::size_t>(y * kShapeSide + x);
      bits[bit / 64] |= std::uint64_t{1} << (bit % 64);
      any = true;
    }
  }
  if (!any)
    return fail(ErrorCode::invalid, "Empty shape",
                "The server found no shape in the picture. It uses the opaque part or, if there is "
                "no transparency, the light part. Send `part=dark` for a dark shape on a light "
                "background.",
                "body");
  return bits;
}

Picture picture_of(const ShapeBits& bits) {
  Picture picture{kShapeSide, kShapeSide, {}};
  picture.rgba.reserve(bits.size() * 64 * 4);
  for (const std::uint64_t word : bits)
    for (int bit = 0; bit < 64; ++bit)
      for (const int channel : {255, 255, 255, (word >> bit & 1) != 0 ? 255 : 0})
        picture.rgba.push_back(static_cast<std::uint8_t>(channel));
  return picture;
}

ShapeTexture::ShapeTexture(const ShapeBits& bits)
    : bits_(bits), distances_(kShapeSide * kShapeSide, 255) {
  constexpr int kLast = kShapeSide - 1;
  const auto at = [&](int x, int y) -> std::uint8_t& {
    return distances_[std::size_t(y * kShapeSide + x)];
  };
  const auto lower = [&](int x, int y, int other_x, int other_y) {
    if (other_x < 0 || other_x > kLast || other_y < 0 || other_y > kLast) return;
    at(x, y) = static_cast<std::uint8_t>(std::min<int>(at(x, y), at(other_x, other_y) + 1));
  };
  // Two passes over eight neighbors give exact chessboard distances.
  for (int y = 0; y <= kLast; ++y) {
    for (int x = 0; x <= kLast; ++x) {
      if (is_set(x, y)) at(x, y) = 0;
      lower(x, y, x - 1, y);
      for (int k = -1; k <= 1; ++k) lower(x, y, x + k, y - 1);
    }
  }
  for (int y = kLast; y >= 0; --y) {
    for (int x = kLast; x >= 0; --x) {
      lower(x, y, x + 1, y);
      for (int k = -1; k <= 1; ++k) lower(x, y, x + k, y + 1);
    }
  }
  constexpr double kCenter = kShapeSide / 2.0;
  for (int y = 0; y <= kLast; ++y) {
    for (int x = 0; x <= kLast; ++x) {
      if (is_set(x, y)) continue;
      const double dx = std::max({x - kCenter, kCenter - (x + 1), 0.0}),
                   dy = std::max({y - kCenter, kCenter - (y + 1), 0.0});
      inner_radius_ = std::min(inner_radius_, std::hypot(dx, dy) / kCenter);
    }
  }
}

bool ShapeTexture::is_set(int x, int y) const {
  const auto bit = static_cast<std::size_t>(y * kShapeSide + x);
  return (bits_[bit / 64] >> (bit % 64) & 1) != 0;
}

}  // namespace strata
