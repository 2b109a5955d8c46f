#include "app/demo/story_photo.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "media/picture.h"
#include "mesh/demo/demo_pot_noise.h"

namespace strata::app {
namespace {
constexpr int kWidth = 640, kHeight = 480;
constexpr int kPixelsPer_mm = 12;
}  // namespace

std::vector<std::uint8_t> story_photo(int seed) {
  std::vector<std::uint8_t> rgba(std::size_t(kWidth) * kHeight * 4, 255);
  const double shift = 37.1 * seed;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const glm::dvec3 p(x / 60.0 + shift, y / 60.0, shift);
      const double slope = mesh::fractal_noise(p * 2.0, 4) - mesh::fractal_noise(p * 2.0 + 0.12, 4);
      glm::dvec3 color =
          glm::dvec3(168, 104, 70) * (0.92 + 1.1 * slope) + 18.0 * mesh::fractal_noise(p * 9.0, 2);
      const double flake = mesh::fractal_noise(p * 0.9 + 5.0, 4);
      if (flake > 0.12)
        color = glm::mix(color, glm::dvec3(224, 196, 164) * (0.95 + slope),
                         std::clamp((flake - 0.12) * 14, 0.0, 0.85));
      else if (flake > 0.09)
        color *= 0.55;  // shadow at the edge of the flake
      // The scale bar: 10 mm in black and white.
      const int from_left = x - 40, from_bottom = kHeight - 40 - y;
      if (from_left >= -6 && from_left < 10 * kPixelsPer_mm + 6 && from_bottom >= -6 &&
          from_bottom < 20)
        color = glm::dvec3(245);
      if (from_left >= 0 && from_left < 10 * kPixelsPer_mm && from_bottom >= 0 && from_bottom < 14)
        color = glm::dvec3((from_left / (2 * kPixelsPer_mm)) % 2 == 0 ? 20 : 235);
      for (int c = 0; c < 3; ++c)
        rgba[(std::size_t(y) * kWidth + x) * 4 + c] =
            static_cast<std::uint8_t>(std::clamp(color[c], 0.0, 255.0));
    }
  return encode_jpeg(rgba, kWidth, kHeight, {85, true});
}

}  // namespace strata::app
