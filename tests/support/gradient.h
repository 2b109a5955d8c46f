#pragma once

#include <cstdint>
#include <vector>

namespace strata::test {

// Returns an opaque RGBA8 image, top row first: red increases to the right, green downwards.
inline std::vector<std::uint8_t> gradient(int width, int height) {
  std::vector<std::uint8_t> rgba(std::size_t(width) * height * 4);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      auto* p = &rgba[(std::size_t(y) * width + x) * 4];
      p[0] = static_cast<std::uint8_t>(x * 255 / width);
      p[1] = static_cast<std::uint8_t>(y * 255 / height);
      p[2] = 90;
      p[3] = 255;
    }
  return rgba;
}

}  // namespace strata::test
