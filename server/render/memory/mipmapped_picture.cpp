#include "render/memory/mipmapped_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace strata::render {
namespace {

// The number of light values in the table for the conversion back to sRGB. Their steps are finer
// than those of sRGB, except for the darkest few values.
constexpr int kCodes = 4096;

double light_of(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}
double srgb_of(double light) {
  return light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

struct Tables {
  std::array<float, 256> light;  // 0…kCodes
  std::array<std::uint8_t, kCodes + 1> srgb;
  Tables() {
    for (std::size_t i = 0; i < light.size(); ++i)
      light[i] = static_cast<float>(kCodes * light_of(double(i) / 255));
    for (std::size_t i = 0; i < srgb.size(); ++i)
      srgb[i] = static_cast<std::uint8_t>(std::lround(255 * srgb_of(double(i) / kCodes)));
  }
};

void turn_upside_down(std::vector<std::uint8_t>& rgba, int width, int height) {
  const auto row = static_cast<std::ptrdiff_t>(width) * 4;
  for (int y = 0; y < height / 2; ++y)
    std::swap_ranges(rgba.begin() + y * row, rgba.begin() + (y + 1) * row,
                     rgba.begin() + (height - 1 - y) * row);
}

MipmappedPicture::Level half_of(const MipmappedPicture::Level& fine) {
  static const Tables tables;
  MipmappedPicture::Level level{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}};
  level.rgba.resize(std::size_t{4} * static_cast<std::size_t>(level.width) *
                    static_cast<std::size_t>(level.height));
  std::uint8_t* out = level.rgba.data();
  for (int y = 0; y < level.height; ++y) {
    for (int x = 0; x < level.width; ++x, out += 4) {
      std::array<float, 3> weighted{}, plain{};
      float alpha = 0;
      for (const int dy : {0, 1}) {
        for (const int dx : {0, 1}) {
          const auto column = static_cast<std::size_t>(std::min(2 * x + dx, fine.width - 1));
          const auto row = static_cast<std::size_t>(std::min(2 * y + dy, fine.height - 1));
          const std::uint8_t* texel =
              &fine.rgba[4 * (row * static_cast<std::size_t>(fine.width) + column)];
          for (std::size_t c = 0; c < 3; ++c) {
            plain[c] += tables.light[texel[c]];
            weighted[c] += tables.light[texel[c]] * texel[3];
          }
          alpha += texel[3];
        }
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const float light = alpha > 0 ? weighted[c] / alpha : plain[c] / 4;
        out[c] = tables.srgb[static_cast<std::size_t>(std::min(light + 0.5f, float{kCodes}))];
      }
      out[3] = static_cast<std::uint8_t>(alpha / 4 + 0.5f);
    }
  }
  return level;
}

}  // namespace

std::size_t MipmappedPicture::bytes() const {
  std::size_t sum = 0;
  for (const Level& level : levels) sum += level.rgba.size();
  return sum;
}

MipmappedPicture make_mipmaps(std::vector<std::uint8_t> rgba, int width, int height,
                              int largest_side) {
  turn_upside_down(rgba, width, height);
  MipmappedPicture::Level level{width, height, std::move(rgba)};
  MipmappedPicture image;
  for (;;) {
    const bool last = level.width == 1 && level.height == 1;
    MipmappedPicture::Level next = last ? MipmappedPicture::Level{} : half_of(level);
    if (std::max(level.width, level.height) <= largest_side)
      image.levels.push_back(std::move(level));
    if (last) return image;
    level = std::move(next);
  }
}

}  // namespace strata::render
