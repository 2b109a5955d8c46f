#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace strata::mesh {

inline std::uint32_t channel_byte(double value) {
  // NaN also becomes 0
  return value >= 0 ? static_cast<std::uint32_t>(std::lround(std::min(value, 255.0))) : 0u;
}

inline std::uint32_t pack_color(double red, double green, double blue, double alpha) {
  return channel_byte(red) | channel_byte(green) << 8 | channel_byte(blue) << 16 |
         channel_byte(alpha) << 24;
}

// Convert one channel (0…1) from linear light to sRGB (IEC 61966-2-1) and back. Values outside this
// range and NaN are clamped.
inline double srgb_of_linear(double value) {
  value = value >= 0 ? std::min(value, 1.0) : 0.0;
  return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
}
inline double linear_of_srgb(double value) {
  value = value >= 0 ? std::min(value, 1.0) : 0.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

// Colors given as real numbers have the range 0…1 in some files and 0…255 in others, and no header
// specifies the range. They are read as 0…1 until a channel exceeds 1. This shows that the range is
// 0…255, so the colors that are already stored are rescaled.
class RealColorScale {
 public:
  // `stored` has the colors packed before. A color without alpha is opaque.
  std::uint32_t pack(const double (&rgba)[4], bool has_alpha, std::vector<std::uint32_t>& stored) {
    const int channels = has_alpha ? 4 : 3;
    if (!bytes_ && *std::max_element(rgba, rgba + channels) > 1.0) {
      bytes_ = true;
      for (std::uint32_t& color : stored) {
        for (int shift = 0; shift < 8 * channels; shift += 8) {
          const std::uint32_t channel = (color >> shift) & 0xffu;
          color = (color & ~(0xffu << shift)) | (channel >= 128 ? 1u : 0u) << shift;
        }
      }
    }
    const double scale = bytes_ ? 1.0 : 255.0;
    return pack_color(rgba[0] * scale, rgba[1] * scale, rgba[2] * scale,
                      has_alpha ? rgba[3] * scale : 255.0);
  }

 private:
  bool bytes_ = false;
};

}  // namespace strata::mesh
